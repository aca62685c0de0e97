! Read matrices and equations of motion from files, and write what each function of proprotor.h finds.
! The files hold matrices row by row, as C takes them.
program all_functions
    use proprotor
    use, intrinsic :: iso_c_binding
    implicit none
    integer(c_int), parameter :: n = 5, states = 7
    integer(c_long_long), parameter :: count = 11, motions = 5
    real(c_double) :: matrices(n * n * count), motion(n * n * motions, 3)
    complex(c_double_complex) :: values(n * count), roots(states * motions)
    complex(c_double_complex), target :: vectors(n * n * count)
    integer(c_signed_char) :: handed_over(count), rest(motions)
    integer :: file
    open (newunit=file, file='matrices.bin', access='stream', status='old')
    read (file) matrices
    close (file)
    open (newunit=file, file='motion.bin', access='stream', status='old')
    read (file) motion
    close (file)
    if (proprotor_eigenvalues(n, count, matrices, values, c_loc(vectors), handed_over) /= proprotor_done) stop 2
    if (proprotor_roots_of_motion(n, 2_c_int, [0_c_int, 2_c_int], motions, motion(:, 1), motion(:, 2), motion(:, 3), &
                                  roots, rest) /= proprotor_done) stop 3
    open (newunit=file, file='values.bin', access='stream')
    write (file) values
    close (file)
    open (newunit=file, file='vectors.bin', access='stream')
    write (file) vectors
    close (file)
    open (newunit=file, file='roots.bin', access='stream')
    write (file) roots
    close (file)
    open (newunit=file, file='handed_over.bin', access='stream')
    write (file) handed_over
    close (file)
end program

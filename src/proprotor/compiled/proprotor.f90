! Eigenvalues of many small matrices, and roots of many equations of motion: the functions of proprotor.h for Fortran.
!
! C reads matrices row by row and Fortran column by column, so a matrix arrives transposed: its eigenvalues and, where all
! coordinates are held, its roots stay the same. For right vectors hand over transpose(matrix).
module proprotor
    use, intrinsic :: iso_c_binding, only: c_int, c_long_long, c_double, c_double_complex, c_signed_char, c_ptr
    implicit none
    integer(c_int), parameter :: proprotor_done = 0, proprotor_bad_size = 1, proprotor_no_memory = 2

    interface
        integer(c_int) function proprotor_eigenvalues(n, count, matrices, values, vectors, handed_over) bind(c)
            import :: c_int, c_long_long, c_double, c_double_complex, c_signed_char, c_ptr
            integer(c_int), value :: n
            integer(c_long_long), value :: count
            real(c_double), intent(in) :: matrices(*)
            complex(c_double_complex), intent(out) :: values(*)
            type(c_ptr), value :: vectors ! c_loc of complex numbers, or c_null_ptr
            integer(c_signed_char), intent(out) :: handed_over(*)
        end function

        integer(c_int) function proprotor_roots_of_motion(n, count_held, held, count, mass, damping, stiffness, values, &
                                                          handed_over) bind(c)
            import :: c_int, c_long_long, c_double, c_double_complex, c_signed_char
            integer(c_int), value :: n, count_held
            integer(c_int), intent(in) :: held(*)
            integer(c_long_long), value :: count
            real(c_double), intent(in) :: mass(*), damping(*), stiffness(*)
            complex(c_double_complex), intent(out) :: values(*)
            integer(c_signed_char), intent(out) :: handed_over(*)
        end function
    end interface
end module

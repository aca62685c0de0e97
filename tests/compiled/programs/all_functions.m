% Read matrices and equations of motion from files, and write what each function of proprotor_mex finds.
% The files hold matrices row by row, and real and imaginary part of each complex number side by side.
1;

function found = pages(numbers)
    n = 5;
    found = permute(reshape(numbers, n, n, []), [2 1 3]);
end

function put(name, numbers)
    file = fopen(name, 'w');
    fwrite(file, [real(numbers(:)) imag(numbers(:))].', 'double');
    fclose(file);
end

file = fopen('matrices.bin'); matrices = fread(file, Inf, 'double'); fclose(file);
file = fopen('motion.bin'); motion = reshape(fread(file, Inf, 'double'), [], 3); fclose(file);
[values, handed_over, vectors] = proprotor_mex('eigenvalues', pages(matrices));
roots = proprotor_mex('roots_of_motion', pages(motion(:, 1)), pages(motion(:, 2)), pages(motion(:, 3)), [1 3]);
put('values.bin', values);
put('vectors.bin', permute(vectors, [2 1 3]));
put('roots.bin', roots);
file = fopen('handed_over.bin', 'w'); fwrite(file, handed_over, 'uint8'); fclose(file);

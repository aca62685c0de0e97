"""The generated equations beside other ways to the same matrices: SymPy's Kane, lambdify, JAX."""

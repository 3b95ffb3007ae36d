"""A simulated Matrice 100."""

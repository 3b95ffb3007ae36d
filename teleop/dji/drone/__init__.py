"""The messages of the Matrice 100 (Onboard SDK)."""

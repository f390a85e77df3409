"""The bus and the arm on it."""

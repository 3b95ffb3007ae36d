"""`live --learn`: questions, the controls that answer them, a trial of the result, and the profile that holds it."""

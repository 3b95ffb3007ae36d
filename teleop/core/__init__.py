"""The values, interfaces and errors of the pipeline, and the loop that turns it. No protocol, file or transport."""

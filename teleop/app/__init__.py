"""What the commands do, as functions: values in, values out."""

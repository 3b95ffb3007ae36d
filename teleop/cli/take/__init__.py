"""`teleop take`: one module per subcommand."""

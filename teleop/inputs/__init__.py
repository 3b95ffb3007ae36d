"""What an operator holds: the keys of the terminal, HID devices, recorded sticks."""

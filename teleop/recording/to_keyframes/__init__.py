"""A take as sparse, editable keyframes within a tolerance."""

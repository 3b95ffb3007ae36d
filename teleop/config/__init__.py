"""YAML files to checked objects: loading, checking, profiles and their sections, presets, shipped files."""

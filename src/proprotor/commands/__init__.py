"""The commands of `proprotor`, a module each, and what they share: `arguments` and `output`."""

"""Run the command `proprotor` as ``python -m proprotor``, also where the folder of its script is not searched."""

from proprotor.commands.main import main

if __name__ == "__main__":
    main(prog_name="proprotor")

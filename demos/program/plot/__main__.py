"""Draws Tandem's figures; the program `tandem` starts it.

    python3 plot runs SCHEME,SCHEME... VIEW FOLDER...   figures and report.html of runs
    python3 plot bench FOLDER/NAME.json                 figures beside the numbers of a bench
    python3 plot analysis FOLDER/stability.json         figures beside the numbers of an analysis

VIEW is the program that draws films; it may be empty.
"""

import sys

from command import main

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

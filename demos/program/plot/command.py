"""The commands of this package: figures of runs, and of benches."""

import os
import shutil
import signal
import sys
from multiprocessing import get_context

from table import UsageError


def load_folders(folders):
    """Runs and atlases of the folders, each once, in the order given."""
    from atlas import is_atlas, load_atlas
    from runs import load_run
    runs, atlases = {}, {}
    for folder in folders:
        place = os.path.realpath(folder)
        if is_atlas(folder):
            atlases[place] = atlases.get(place) or load_atlas(folder)
        elif place not in runs:
            runs[place] = load_run(folder)
    return list(runs.values()), list(atlases.values())


_jobs = []  # figures to draw and their folder; processes that fork inherit them


def save(job):
    figure, folder = _jobs[job]
    return figure.name, figure.save(folder)


def draw(figures, folder):
    """Draws on all cores, and says how far it is when somebody watches. Says once what is left
    out."""
    _jobs[:] = [(figure, folder) for figure in figures]
    problems = set()
    watched, workers = sys.stderr.isatty(), len(os.sched_getaffinity(0))
    with get_context("fork").Pool(min(workers, len(figures)) or 1, signal.signal,
                                  (signal.SIGINT, signal.SIG_IGN)) as pool:
        for count, (name, problem) in enumerate(pool.imap_unordered(save, range(len(figures))), 1):
            problems.add(problem)
            if watched:
                sys.stderr.write(f"\r\033[Kfigure {count} of {len(figures)}: {name}")
    if watched:
        sys.stderr.write("\r\033[K")
    for problem in filter(None, problems):
        print(f"tandem: note: {problem}", file=sys.stderr)


def marks(folders):
    """Identity and age of all summaries; another result in a folder changes them."""
    return [(stat.st_ino, stat.st_mtime_ns) for folder in folders
            for name in ("summary.json", "stability.json",
                         *(f"site{site}.json" for site in range(1, 17)))
            if (stat := _stat(os.path.join(folder, name)))]


def _stat(path):
    try:
        return os.stat(path)
    except OSError:
        return None


def publish(draft, home):
    """Moves report and figures home. The report leaves first and comes last: it marks a whole set."""
    report, figures = os.path.join(home, "report.html"), os.path.join(home, "figures")
    if os.path.exists(report):
        os.remove(report)
    os.makedirs(figures, exist_ok=True)
    for name in os.listdir(figures):  # the folder belongs to this command
        if name.endswith((".svg", ".png", ".gif")):
            os.remove(os.path.join(figures, name))
    for name in os.listdir(draft):
        if name != "report.html":
            os.replace(os.path.join(draft, name), os.path.join(figures, name))
    os.replace(os.path.join(draft, "report.html"), report)


def plot_runs(folders):
    """Draws all aside first, so that a failure leaves what was there."""
    before = marks(folders)
    runs, atlases = load_folders(folders)
    from report import Report
    report, home = Report(runs, atlases), folders[0]
    draft = os.path.join(home, ".plot-draft")
    shutil.rmtree(draft, ignore_errors=True)  # a killed program may have left it
    try:
        os.makedirs(draft)
        draw(report.figures, draft)
        with open(os.path.join(draft, "report.html"), "w", encoding="utf-8") as file:
            file.write(report.html(draft))
        if marks(folders) != before:
            raise UsageError(f"{', '.join(folders)}: a run ended here while it was read; plot again")
        publish(draft, home)
    finally:
        shutil.rmtree(draft, ignore_errors=True)
    print(os.path.join(home, "report.html"))


def main(arguments):
    """Runs one command and returns the exit status. Bad input gives one line on stderr."""
    try:
        if arguments[0] == "bench":
            from benches import bench_figures
            draw(bench_figures(arguments[1]), os.path.dirname(arguments[1]))
        elif arguments[0] == "analysis":
            from atlas import load_atlas
            from atlas_figures import atlas_figures
            folder = os.path.dirname(arguments[1])
            draw(atlas_figures(load_atlas(folder)), folder)
        else:
            from film import use_program
            from words import know_schemes
            know_schemes(arguments[1].split(","))
            use_program(arguments[2])
            plot_runs(arguments[3:])
        return 0
    except KeyboardInterrupt:
        return 1
    except UsageError as error:
        message, status = str(error), 2
    except OSError as error:
        message, status = f"{error.filename}: {error.strerror}", 1
    print("tandem: " + "".join(c if c.isprintable() else "?" for c in message), file=sys.stderr)
    return status

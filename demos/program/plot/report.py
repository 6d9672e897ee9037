"""The report: headings, findings, figures and tables in reading order."""

import math
from html import escape

from atlas_section import stability_figures
from film import Film, can_film
from findings import coherency_findings, contact_findings, sweep_findings
from grouping import Grouping, text_without_scheme
from many_figures import many_matrices, many_motion, many_overview
from many_runs import group_many
from many_tables import many_table
from page import figure, page
from paper import paper_outcome
from run_figures import contact_motion, cooperation_motion, live_motion, spatial_motion
from run_tables import contact_table, live_table, run_table, sweep_table
from runs import CONTACT, COOPERATION, PLAYGROUND
from scene import load_motion
from scheme_figures import coherency_bars, coherency_over_time, sweep_figure
from top_view import top_view
from words import SCHEMES

_KINDS = {COOPERATION: "Cooperation", CONTACT: "User-to-user contact", PLAYGROUND: "Playground"}


class Report:
    """Pieces of HTML, and figures that are drawn before the page is written."""

    def __init__(self, runs, atlases=()):
        named = [*runs, *atlases]
        self.title = f"Tandem: {named[0].title}" if len(named) == 1 else \
            f"Tandem: {len(runs)} runs compared" if runs else \
            f"Tandem: stability of {len(atlases)} scenarios"
        self.blocks, self.figures = [], []
        self.heading(1, self.title)
        self.paragraph(
            "Two people who are far apart push the same object, or each other, with haptic "
            "devices. Each site simulates its own copy of the scene; states travel over a network "
            "with delay. The figures show how well the copies agree and how contact feels under "
            "each scheme.")
        many = [run for run in runs if run.sites > 2]
        runs = [run for run in runs if run.sites == 2]
        grouping = Grouping(runs)
        virtual = [run for run in runs if not run.is_live]
        self._add_glance(grouping)
        self._add_cooperation(grouping.groups[COOPERATION])
        self._add_contact(grouping.groups[CONTACT])
        self._add_sweeps(grouping.sweeps)
        self._add_playgrounds([run for run in virtual if run.kind == PLAYGROUND])
        self._add_many(group_many(many))
        self._add_live([(run, _twin_of(run, virtual)) for run in runs if run.is_live])
        self._add_stability(list(atlases))
        self._add_numbers(virtual)

    def heading(self, level, text, difference=""):
        text = f"{text}: {difference}" if difference else text
        self.blocks.append(f"<h{level}>{escape(text)}</h{level}>\n")

    def paragraph(self, html):
        self.blocks.append(f"<p>{html}</p>\n")

    def list(self, items):
        if items:
            self.blocks.append("<ul>\n" + "".join(f"<li>{item}</li>\n" for item in items)
                               + "</ul>\n")

    def figure(self, picture):
        self.blocks.append(picture)
        self.figures.append(picture)

    def html(self, folder):
        """The page; `folder` has the figures' files."""
        return page(self.title, "".join(block if isinstance(block, str) else figure(block, folder)
                                        for block in self.blocks))

    def _add_glance(self, grouping):
        cooperation = grouping.groups[COOPERATION]
        findings = coherency_findings(cooperation[0]) if len(cooperation) == 1 else []
        findings += contact_findings(grouping.groups[CONTACT])
        for sweep in grouping.sweeps:
            findings += sweep_findings(sweep)
        if findings:
            self.heading(2, "What was found")
            self.list(findings)

    def _add_scene(self, run, prefix):
        if run.bodies and not run.is_live:
            motion = load_motion(run)
            if can_film():
                self.figure(Film(run, motion.times, f"{prefix}-film"))
            self.figure(top_view(run, motion, f"{prefix}-top-view"))

    def _add_cooperation(self, groups):
        for prefix, group in _with_prefixes("cooperation", groups):
            self.heading(2, "Cooperation: two users move one object", group.difference)
            if len(groups) > 1:
                self.list(coherency_findings(group))
            if len(group.runs) > 1:
                self.figure(coherency_bars(group, f"{prefix}-coherency"))
            self.figure(coherency_over_time(group.runs, f"{prefix}-coherency-over-time"))
            self.figure(cooperation_motion(group, f"{prefix}-motion"))
            # The proxies of the last scheme are bodies of their own.
            self._add_scene(group.runs[-1], prefix)

    def _add_contact(self, groups):
        if not groups:
            return
        self.heading(2, "User-to-user contact")
        self.paragraph(
            "User 1 pushes user 2 with no object between them. A good scheme touches once and "
            "stays in contact; the number of changes counts how often contact goes on or off.")
        self.blocks.append(contact_table(groups))
        for prefix, group in _with_prefixes("contact", groups):
            if group.difference:
                self.heading(3, "Case", group.difference)
            self.figure(contact_motion(group, f"{prefix}-motion"))
            if group is groups[0]:
                self._add_scene(group.runs[-1], prefix)

    def _add_sweeps(self, sweeps):
        for prefix, sweep in _with_prefixes("sweep", sweeps):
            what = "user-to-user contact" if sweep.kind == CONTACT else "cooperation"
            self.heading(2, f"Device damping and {what}", sweep.difference)
            self.figure(sweep_figure(sweep, prefix))
            self.blocks.append(sweep_table(sweep))

    def _add_playgrounds(self, runs):
        for prefix, run in _with_prefixes("playground", runs):
            self.heading(2, run.title)
            self._add_scene(run, prefix)
            self.figure(spatial_motion(run, f"{prefix}-motion"))
            if run.has_object:
                self.figure(coherency_over_time([run], f"{prefix}-coherency-over-time"))

    def _add_many(self, groups):
        if groups:
            self.heading(2, "More than two users")
            self.paragraph(
                "N sites, each with a copy of the object that is tied to all others. Drag is what "
                "holds each user back when all move on together: the force per speed, without the "
                "device’s own damping.")
        for prefix, group in _with_prefixes("many", groups):
            self.heading(3, group.title)
            if len({run.sites for run in group.runs}) > 1 and group.has_object:
                self.figure(many_overview(group, f"{prefix}-overview"))
            self.blocks.append(many_table(group))
            for number, run in enumerate(group.shown, 1):
                self.figure(many_motion(run, f"{prefix}-motion-{number}"))
                self.figure(many_matrices(run, f"{prefix}-pairs-{number}"))
            self._add_scene(group.shown[-1], prefix)

    def _add_live(self, pairs):
        if not pairs:
            return
        pairs.sort(key=_live_order)
        self.heading(2, "Live beside virtual time")
        self.blocks.append(live_table(pairs))
        columns = {}  # pairs that differ in nothing but the scheme share a figure
        for pair in pairs:
            columns.setdefault(text_without_scheme(pair[0]), []).append(pair)
        for number, members in enumerate(columns.values(), 1):
            self.figure(live_motion(members, f"live-{number}"))

    def _add_stability(self, atlases):
        if not atlases:
            return
        self.heading(2, "Stability with lasting contact")
        self.paragraph(
            "Whether a small motion dies out while all contacts last, along one line: the tick, "
            "packets and delay are as in a run. It tells what no single run can: how far gains "
            "are from the border, and what the delay costs.")
        for text, pictures in stability_figures(atlases):
            self.paragraph(text)
            for picture in pictures:
                self.figure(picture)

    def _add_numbers(self, runs):
        if not runs:
            return
        self.heading(2, "All runs: asked and reached")
        if any(paper_outcome(run) for run in runs):
            self.paragraph(
                "Small grey numbers are the outcomes of Li and Constantinescu’s equations (2009), "
                "shown where a run has the settings of their experiments. Intermittent contact is "
                "chaotic: there only the size of count and force means something.")
        for kind, heading in _KINDS.items():
            members = [run for run in runs if run.kind == kind]
            if members:
                self.heading(3, heading)
                self.blocks.append(run_table(members))
        self.paragraph(
            "Hands: constant force of the hands of users 1 and 2 along x. K_vc, B_vc: stiffness "
            "and damping of contact; K_t, B_t: of the coordination over the network. b_dev: the "
            "device’s own damping. Received: a site’s own copy against the other as it arrives "
            "there.")


def _with_prefixes(kind, members):
    """File names of figures: "cooperation-…", or "cooperation2-…" for the second of several."""
    return [(f"{kind}{place}" if len(members) > 1 else kind, member)
            for place, member in enumerate(members, 1)]


def _twin_of(live, virtual):
    """The run in virtual time that was asked for the same, or None."""
    return next((run for run in virtual if run.settings == live.settings), None)


def _live_order(pair):
    delay = pair[0].setting("network.delay")
    return (list(_KINDS).index(pair[0].kind), delay if math.isfinite(delay) else 0.0,
            text_without_scheme(pair[0]), SCHEMES.index(pair[0].scheme))

"""What the numbers say, in words. Only the order that the paper reports is known beforehand."""

import math
from html import escape

from runs import CONTACT, NAN
from words import SCHEMES, join_words, number_text, scheme_label

# Ways to measure how far apart the two copies of the object are [m].
MEASURES = {"at equal time": "coherency.mean_abs",
            "as received at site 1": "site1.coherency.received_mean",
            "as received at site 2": "site2.coherency.received_mean"}

# The paper's Figure 5, worst first.
_PAPER_ORDER = ["virtual_coupling", "remote_dynamic_proxy", "kinematic_proxy"]

# Contact that is made and lost at least this often is called intermittent.
INTERMITTENT_CHANGES = 20


class Order:
    """How the schemes of a group rank by one measure."""

    def __init__(self, group, measure):
        def value(run):
            return run.number(MEASURES[measure])

        self.worst_first = sorted((run for run in group.runs if math.isfinite(value(run))),
                                  key=value, reverse=True)
        self.values = [number_text(value(run) * 1e3) for run in self.worst_first]  # [mm]
        self.text = " > ".join(f"{scheme_label(run.scheme)} ({text} mm)"
                               for run, text in zip(self.worst_first, self.values))
        self.is_complete = len(self.worst_first) == len(_PAPER_ORDER)
        self.is_the_papers = [run.scheme for run in self.worst_first] == _PAPER_ORDER


def changes_of(run):
    """How often contact of user 1 goes on or off; NaN without a run."""
    return run.number("site1.contact_transitions") if run else NAN


def contact_verdict(changes):
    if not math.isfinite(changes):
        return "–"
    if changes >= INTERMITTENT_CHANGES:
        return "intermittent"
    return {0: "no contact", 1: "kept after the first touch"}.get(changes, "bounces")


def changes_text(changes):
    return f"{changes:g} {'change' if changes == 1 else 'changes'}"


def coherency_findings(group):
    """One sentence per measure on how the schemes rank."""
    findings = []
    for measure in MEASURES:
        order = Order(group, measure)
        if len(order.worst_first) < 2:
            continue
        verdict = ""
        if order.is_complete:
            verdict = " <b>The paper’s order holds.</b>" if order.is_the_papers else \
                " <b>Not the paper’s order.</b>"
        findings.append(f"Mean distance {measure}: {escape(order.text)}.{verdict}")
    return findings


def contact_findings(groups):
    """One sentence per scheme over all cases."""
    findings = []
    for scheme in SCHEMES:
        changes = [changes_of(run) for run in (group.find(scheme) for group in groups) if run]
        if not changes:
            continue
        verdicts = [contact_verdict(value) for value in changes]
        parts = [verdict if len(changes) == 1 else
                 f"{verdict} in {verdicts.count(verdict)} of {len(changes)} cases"
                 for verdict in sorted(set(verdicts))]
        low, high = min(changes), max(changes)
        span = changes_text(low) if low == high else f"{low:g} to {high:g} changes"
        findings.append(f"User-to-user contact, {scheme_label(scheme)}: {join_words(parts)} "
                        f"({span}).")
    return findings


def _where_holds(sweep, holds):
    """ "only at b_dev = 0 and 0.5 N s/m", "at none of ...", "at all of ..." """
    every = [f"{point.damping:g}" for point in sweep.points]
    where = [f"{point.damping:g}" for point in sweep.points if holds(point)]
    if not where or len(where) == len(every):
        return f"at {'all' if where else 'none'} of b_dev = {join_words(every)} N s/m"
    return f"only at b_dev = {join_words(where)} N s/m"


def sweep_findings(sweep):
    """Sentences on a whole sweep: where the paper's order holds, or where contact is kept."""
    if sweep.kind == CONTACT:
        return _contact_sweep_findings(sweep)
    findings = []
    for measure in MEASURES:
        if all(Order(point, measure).is_complete for point in sweep.points):
            where = _where_holds(sweep, lambda point: Order(point, measure).is_the_papers)
            findings.append("The paper’s order (virtual coupling worst, kinematic proxy best) "
                            f"against device damping, {measure}: holds {where}.")
    return findings


def _contact_sweep_findings(sweep):
    def where(scheme, holds):
        return _where_holds(sweep, lambda point: holds(changes_of(point.find(scheme))))

    complete = [scheme for scheme in sweep.schemes
                if all(point.find(scheme) for point in sweep.points)]
    findings = []
    if "kinematic_proxy" in complete:
        findings.append(
            f"Kinematic proxy: contact is intermittent ({INTERMITTENT_CHANGES} changes or more) "
            f"{where('kinematic_proxy', lambda changes: changes >= INTERMITTENT_CHANGES)}.")
    if "remote_dynamic_proxy" in complete:
        findings.append("Remote dynamic proxy: the first touch is kept (exactly one change) "
                        f"{where('remote_dynamic_proxy', lambda changes: changes == 1)}.")
    return findings

"""Runs of more than two sites: numbers, groups, colours, figures and report."""

import unittest

from support import CONTACT, RDP, VC, FolderTest, message_of, run_of, site_csv, summary

import numpy as np

from canvas import Sheet
from many_figures import many_matrices, many_motion, many_overview
from many_runs import coupler_drag, group_many, hands_of
from many_tables import many_table
from report import Report
from runs import Body, load_run, make_run
from words import body_colour, user_colour


def many(count, scheme=RDP, kind="cooperative_manipulation", mode="sum"):
    """A summary of `count` sites."""
    s = summary(scheme, kind)
    del s["scenario"]["site1"], s["scenario"]["site2"]
    s["scenario"]["site"] = [{"hand_force": [4 - user % 2 * 6, 0, 0]} for user in range(count)]
    s["scenario"]["coordination"]["mode"] = mode
    names = [f"site{user + 1}" for user in range(count)]
    for name in names:
        s[name] = dict(s["site1"])
    s["coherency"]["pairs"] = [{"i": i + 1, "j": j + 1, "mean": 1e-3 * (i + j), "max": 0.01}
                               for i in range(count) for j in range(i + 1, count)]
    s["drag"] = {"force": 1.0, "speed": 0.04, "per_speed": 25.0}
    s["contacts"] = {own: {"object": 0.95} | {other: 0.25 for other in names if other != own}
                     for own in names}
    return s


def many_run(count, scheme=RDP, mode="sum"):
    return make_run(many(count, scheme, mode=mode), f"{scheme}{count}", "summary.json")


class ManyLiveRuns(FolderTest):
    def setUp(self):
        super().setUp()
        for site in (1, 2, 3):
            self.write_site(site)

    def write_site(self, site, count=3):
        name = f"site{site}"
        own = {key: many(count)[key] for key in ("scenario", name)} | {
            "loop": {"ticks": 100, "late": site}, "contacts": {name: many(count)["contacts"][name]}}
        self.write(f"{name}.json", own)
        self.write(f"{name}.csv", site_csv(0.001 * site, 30 + site))

    def test_join_what_all_sites_know(self):
        run = load_run(str(self.folder))
        self.assertTrue(run.is_live)
        self.assertEqual(run.sites, 3)
        self.assertAlmostEqual(run.number("coherency.mean_abs"), 0.002)
        self.assertAlmostEqual(run.number("coherency.pairs.0.mean"), 0.001)
        self.assertEqual(run.number("contacts.site3.site1"), 0.25)
        self.assertAlmostEqual(run.number("loop.late_share"), 0.02)

    def test_one_that_is_missing_or_of_another_run_is_named(self):
        self.write_site(3, count=4)
        self.assertIn("site3.json: another scenario", message_of(lambda: load_run(str(self.folder))))
        (self.folder / "site3.json").unlink()
        self.assertIn("site3.json: cannot", message_of(lambda: load_run(str(self.folder))))


class ManyRuns(unittest.TestCase):
    def test_the_number_of_sites(self):
        self.assertEqual(run_of().sites, 2)
        self.assertEqual(many_run(11).sites, 11)

    def test_groups_differ_in_number_scheme_and_mode_alone(self):
        runs = [many_run(4), many_run(3), many_run(3, VC), many_run(3, mode="average")]
        group, = group_many(runs)
        self.assertEqual({label: [run.sites for run in members]
                          for label, members in group.series.items()},
                         {"remote dynamic proxy, sum": [3, 4], "virtual coupling, sum": [3],
                          "remote dynamic proxy, average": [3]})
        self.assertEqual([run.sites for run in group.shown], [4, 3, 3])
        self.assertEqual(hands_of(runs[0]), "4 / -2")

    def test_the_drag_of_couplers_alone(self):
        self.assertAlmostEqual(coupler_drag(many_run(4)), 3 * 200 * (0.05 + 1 / 256))
        self.assertAlmostEqual(coupler_drag(many_run(4, mode="average")),
                               0.25 * coupler_drag(many_run(4)))

    def test_users_keep_their_colour_at_all_sites(self):
        def body(site, name):
            return Body(site, name, name.rstrip("0123456789"), False)
        self.assertEqual([body(2, name).user for name in ("device", "proxy", "proxy2", "proxy3")],
                         [2, 1, 3, 4])
        self.assertEqual(body(1, "proxy").user, 2)
        self.assertEqual(body_colour(body(4, "proxy3")), body_colour(body(3, "device")))
        self.assertEqual(len({user_colour(user) for user in range(1, 9)}), 8)
        self.assertEqual(user_colour(9), user_colour(1))


class ManyFigures(FolderTest):
    def make_folder(self, count, *arguments, **more):
        name = f"run{count}"
        self.write(f"{name}/summary.json", many(count, *arguments, **more))
        for site in range(1, count + 1):
            self.write(f"{name}/site{site}.csv", site_csv(1e-3 * site))
        return load_run(str(self.folder / name))

    def paint(self, figure):
        sheet = Sheet(figure.title, figure.height)
        figure.paint(sheet)
        return sheet.drawing

    def test_all_users_are_drawn(self):
        run = self.make_folder(16)
        drawing = self.paint(many_motion(run, "motion"))
        for axes in drawing.axes:
            self.assertEqual(len(axes.lines), 16)
        texts = [text.get_text() for text in drawing.legends[0].get_texts()]
        self.assertEqual(texts, [f"user {user}" for user in range(1, 17)])

    def expect_legend_inside(self, figure):
        drawing = self.paint(figure)
        drawing.canvas.draw()
        box = drawing.legends[0].get_window_extent()
        self.assertGreater(box.x0, 0)
        self.assertLess(box.x1, drawing.bbox.width)
        return drawing.legends[0]

    def test_the_legend_of_eight_is_within_the_picture(self):
        self.expect_legend_inside(many_motion(self.make_folder(8), "motion"))

    def test_a_legend_too_long_for_a_row_gets_more_of_them(self):
        group, = group_many([many_run(n, scheme, mode) for n in (3, 4) for scheme in (VC, RDP)
                             for mode in ("sum", "average")])
        legend = self.expect_legend_inside(many_overview(group, "overview"))
        self.assertEqual(len(legend.get_texts()), 5)

    def test_matrices_have_each_pair_twice(self):
        pairs, felt = self.paint(many_matrices(self.make_folder(3), "pairs")).axes
        matrix = np.array(pairs.images[0].get_array().filled(np.nan))
        np.testing.assert_allclose(matrix, [[np.nan, 1, 2], [1, np.nan, 3], [2, 3, np.nan]])
        self.assertEqual(felt.images[0].get_array()[2].tolist(), [25, 25, None, 95])

    def test_without_an_object_there_are_no_distances(self):
        run = self.make_folder(3, VC, CONTACT)
        run.bodies = [Body(1, "device", "device", False, radius=0.01)]
        self.assertEqual(len(self.paint(many_matrices(run, "pairs")).axes), 1)
        self.assertEqual(len(self.paint(many_motion(run, "motion")).axes), 2)

    def test_the_overview_has_a_curve_for_each_scheme_and_mode(self):
        group, = group_many([many_run(n, mode=mode) for n in (3, 4, 8)
                             for mode in ("sum", "average")])
        coherency, drag, force = self.paint(many_overview(group, "overview")).axes
        self.assertEqual([len(coherency.lines), len(drag.lines), len(force.lines)], [2, 4, 2])
        self.assertEqual(drag.lines[0].get_xdata().tolist(), [3, 4, 8])

    def test_only_common_motion_has_a_drag(self):
        group, = group_many([many_run(3), many_run(4)])
        self.assertIn("drag", many_table(group))
        group.runs[0].values["contacts.site2.object"] = 0.1
        self.assertNotIn("drag", many_table(group))
        _, way, _ = self.paint(many_overview(group, "overview")).axes
        self.assertEqual((way.get_title(), len(way.lines)), ("way of user 1", 1))

    def test_the_report_has_them_beside_runs_of_two(self):
        two = load_run(self.make_run_folder("two"))
        report = Report([two, self.make_folder(4), self.make_folder(3)])
        names = [figure.name for figure in report.figures]
        for name in ("many-overview", "many-motion-1", "many-pairs-1", "cooperation-motion"):
            self.assertIn(name, names)
        self.assertIn("More than two users", "".join(b for b in report.blocks if isinstance(b, str)))


if __name__ == "__main__":
    unittest.main()

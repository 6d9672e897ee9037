"""Maps and curves of stability: files, axes, borders, figures, and the report's section."""

import contextlib
import io
import unittest
import xml.etree.ElementTree as xml

import numpy as np

from support import KP, RDP, VC, FolderTest, message_of

from atlas import is_atlas, load_atlas
from atlas_figures import (damping_figure, fine_figure, limits_figure, touch_figure,
                           users_figure)
from atlas_maps import log_tics, map_figure
from canvas import Sheet
from command import main

DELAY, STIFFNESS = "network.delay", "coordination.stiffness"


def csv(border=200.0, columns=5, rows=4):
    """A map that is stable below a stiffness which falls with the delay."""
    lines = [f"{DELAY},{STIFFNESS},rate"]
    for y in np.geomspace(10, 1000, rows):
        for x in np.linspace(0, 0.2, columns):
            lines.append(f"{x},{y},{np.log(y / border) + 10 * (x - 0.1)}")
    return "\n".join(lines) + "\n"


def one_map(scheme, columns=5, rows=4):
    return {"scheme": scheme, "file": f"map-{scheme}.csv",
            "x": {"key": DELAY, "unit": "s", "points": columns, "value": 0.05},
            "y": {"key": STIFFNESS, "unit": "N/m", "points": rows, "value": 200.0}}


def curves(*names, x=(0.0, 0.1, 0.2), values=(1.0, None, 3.0)):
    return {"x": list(x), "curves": [{"name": name, "values": list(values)} for name in names]}


class AtlasFolder(FolderTest):
    def make_atlas(self, name="one", schemes=(RDP,), count=2, has_object=True, **figures):
        self.write(f"{name}/stability.json", {
            "format": "tandem-stability", "title": "Experiment I: a cube", "scheme": RDP,
            "users": count, "has_object": has_object,
            "gains": {DELAY: 0.05, STIFFNESS: 200.0, "device.damping": 0.5},
            "maps": [one_map(scheme) for scheme in schemes], "curves": figures})
        for scheme in schemes:
            self.write(f"{name}/map-{scheme}.csv", csv())
        return str(self.folder / name)

    def make_whole(self, name="one"):
        return self.make_atlas(
            name, (VC, KP, RDP), damping=curves(VC, KP, RDP), fine=curves(VC, KP, RDP),
            users=curves(f"{VC}/sum", f"{RDP}/average_whole", x=(2, 3, 4)),
            coordination_limits=curves("exact", "chain", "every_delay", "grounded_damper"),
            contact_limits=curves("exact", "wall") | {"curves": [
                {"name": "exact", "values": [9.0, 5.0, 3.0]},
                {"name": "colgate_schenkel", "values": [None] * 3}]})


def paint(figure):
    sheet = Sheet(figure.title, figure.height)
    figure.paint(sheet)
    return sheet.drawing


def legend_of(drawing):
    return [text.get_text() for text in drawing.legends[0].get_texts()]


class LoadTest(AtlasFolder):
    def test_reads_maps_by_rows_of_y(self):
        atlas = load_atlas(self.make_atlas(damping=curves(RDP)))
        one = atlas.maps[0]
        self.assertEqual(one.rates.shape, (4, 5))
        np.testing.assert_allclose(one.x.values, [0, 0.05, 0.1, 0.15, 0.2])
        np.testing.assert_allclose(one.y.values, np.geomspace(10, 1000, 4))
        self.assertAlmostEqual(one.rates[3, 4], np.log(1000 / 200) + 1)
        self.assertEqual((one.x.is_logarithmic, one.y.is_logarithmic), (False, True))
        self.assertEqual((one.x.value, one.y.value), (0.05, 200))
        self.assertEqual(atlas.short_title, "Experiment I")
        np.testing.assert_equal(atlas.curves["damping"].curves[RDP], [1, np.nan, 3])

    def test_a_run_in_the_same_folder_goes_first(self):
        folder = self.make_atlas()
        self.assertTrue(is_atlas(folder))
        self.write("one/summary.json", "{}")
        self.assertFalse(is_atlas(folder))

    def test_messages_name_the_file(self):
        folder = self.make_atlas()
        self.write(f"one/map-{RDP}.csv", csv(rows=3))
        self.assertIn(f"map-{RDP}.csv: 15 points, but stability.json tells of 5 x 4",
                      message_of(lambda: load_atlas(folder)))
        self.write(f"one/map-{RDP}.csv", f"{DELAY},rate\n0,1\n")
        self.assertIn("1 points", message_of(lambda: load_atlas(folder)))
        self.write("one/stability.json", {"format": "tandem-bench-stress"})
        self.assertIn('key "format" is not tandem-stability',
                      message_of(lambda: load_atlas(folder)))
        self.write("one/stability.json", "[]")
        self.assertIn("not a JSON object", message_of(lambda: load_atlas(folder)))
        self.make_atlas(damping={"x": 5})
        self.assertIn("damaged", message_of(lambda: load_atlas(folder)))
        odd = one_map(RDP)
        odd["x"]["key"] = "object.mass"
        self.write("one/stability.json", {"format": "tandem-stability", "maps": [odd]})
        self.assertIn('key "maps.0.x.key" is "object.mass"; allowed are',
                      message_of(lambda: load_atlas(folder)))


class MapTest(AtlasFolder):
    def test_axes_have_the_units_they_say(self):
        drawing = paint(map_figure(load_atlas(self.make_atlas()), "map"))
        axes = drawing.axes[0]
        self.assertEqual(axes.get_xlabel(), "delay T_d [ms]")
        self.assertEqual(axes.get_xlim(), (0, 200))
        self.assertEqual(axes.get_ylabel(), "coordination stiffness K_t [N/m]")
        self.assertEqual((axes.get_xscale(), axes.get_yscale()), ("linear", "log"))
        here = axes.lines[-1]
        self.assertEqual((here.get_xdata()[0], here.get_ydata()[0]), (50, 200))

    def test_the_border_is_where_the_rate_is_0(self):
        axes = paint(map_figure(load_atlas(self.make_atlas()), "map")).axes[0]
        lines = [path.vertices for lines in axes.collections[1:] for path in lines.get_paths()]
        x, y = np.concatenate([line for line in lines if len(line)]).T
        at = np.argmin(abs(x - 100))
        self.assertAlmostEqual(x[at], 100, delta=0.5)
        self.assertAlmostEqual(np.log(y[at] / 200), 0, delta=0.5)  # between points of the map

    def test_without_a_border_the_legend_has_none(self):
        folder = self.make_atlas()
        self.assertIn("border of stability",
                      legend_of(paint(map_figure(load_atlas(folder), "map"))))
        self.write(f"one/map-{RDP}.csv", csv(border=1e9))
        self.assertEqual(legend_of(paint(map_figure(load_atlas(folder), "map"))),
                         ["Experiment I’s own values"])

    def test_a_gain_of_0_is_marked_at_the_end_of_its_axis(self):
        atlas = load_atlas(self.make_atlas())
        atlas.maps[0].y.value = 0.0
        here = paint(map_figure(atlas, "map")).axes[0].lines[-1]
        self.assertAlmostEqual(here.get_ydata()[0], 10)

    def test_a_panel_for_each_scheme(self):
        drawing = paint(map_figure(load_atlas(self.make_atlas(schemes=(VC, KP, RDP))), "map"))
        self.assertEqual([axes.get_title() for axes in drawing.axes],
                         ["virtual coupling", "kinematic proxy", "remote dynamic proxy",
                          "rate [1/s]"])

    def test_the_title_tells_scheme_and_number_of_users(self):
        figure = map_figure(load_atlas(self.make_atlas(count=4)), "map")
        self.assertEqual(figure.title, "Growth of small motions: Experiment I, remote dynamic "
                         "proxy, 4 users")

    def test_tics_are_1_and_3_times_powers_of_ten(self):
        self.assertEqual(log_tics(2, 400), {3: "3", 10: "10", 30: "30", 100: "100", 300: "300"})
        self.assertEqual(list(log_tics(0.02, 0.2).values()), ["0.03", "0.1"])
        self.assertEqual(list(log_tics(9e4, 4e5).values()), ["10⁵", "3·10⁵"])


class CurveTest(AtlasFolder):
    def setUp(self):
        super().setUp()
        self.atlas = load_atlas(self.make_whole())

    def test_damping_has_a_line_for_each_scheme_of_each_scenario(self):
        drawing = paint(damping_figure([self.atlas, self.atlas], "damping"))
        self.assertEqual(len(drawing.axes[0].lines), 3 + 3 + 1)
        self.assertEqual(drawing.axes[0].get_xlim(), (0, 200))
        np.testing.assert_allclose(drawing.axes[0].lines[0].get_xdata(), [0, 100, 200])
        self.assertIn("b_dev of the scenario", legend_of(drawing))

    def test_users_say_which_mode(self):
        drawing = paint(users_figure(self.atlas, "users"))
        self.assertEqual(legend_of(drawing), ["virtual coupling, sum",
                                              "remote dynamic proxy, average, whole proxies"])

    def test_a_criterion_that_allows_nothing_is_in_the_legend(self):
        drawing = paint(limits_figure(self.atlas, "limits"))
        self.assertEqual(len(drawing.axes), 2)
        self.assertIn("b > K T/2 + B (Colgate–Schenkel): allows none", legend_of(drawing))

    def test_fine_steps_have_a_panel_for_each_scheme(self):
        drawing = paint(fine_figure([self.atlas], "fine"))
        self.assertEqual([axes.get_title() for axes in drawing.axes],
                         ["virtual coupling", "kinematic proxy", "remote dynamic proxy"])

    def test_touches_have_a_curve_for_each_stiffness(self):
        atlas = load_atlas(self.make_atlas("walls", has_object=False,
                                           touch=curves("500", "2000", x=(0.0, 0.5, 1.0))))
        drawing = paint(touch_figure(atlas, "touch"))
        self.assertEqual(legend_of(drawing)[:2], ["K_vc = 500 N/m", "K_vc = 2000 N/m"])


def run(*arguments):
    """Exit status, standard output and standard error."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = main(list(arguments))
    return status, out.getvalue(), err.getvalue()


class CommandTest(AtlasFolder):
    def test_figures_go_beside_the_numbers(self):
        folder = self.make_whole()
        self.assertEqual(run("analysis", f"{folder}/stability.json"), (0, "", ""))
        pictures = sorted(path.name for path in (self.folder / "one").glob("*.svg"))
        self.assertEqual(pictures,
                         ["damping.svg", "fine.svg", "limits.svg", "map.svg", "users.svg"])
        for name in pictures:
            self.assertEqual(xml.parse(self.folder / "one" / name).getroot().get("width"), "675pt")

    def test_a_report_has_runs_and_analyses(self):
        analysis, own = self.make_whole(), self.make_run_folder("run")
        status, out, err = run("runs", f"{VC},{KP},{RDP}", "", own, analysis, analysis)
        self.assertEqual((status, out, err), (0, f"{own}/report.html\n", ""))
        report = (self.folder / "run/report.html").read_text()
        self.assertIn("Stability with lasting contact", report)
        self.assertEqual(report.count('id="stability-'), 5)
        self.assertIn("cooperation-motion", report)

    def test_a_report_of_an_analysis_alone(self):
        folder = self.make_atlas()
        self.assertEqual(run("runs", f"{VC},{KP},{RDP}", "", folder)[0], 0)
        report = (self.folder / "one/report.html").read_text()
        self.assertIn("<title>Tandem: Experiment I: a cube</title>", report)
        self.assertEqual(report.count("<figure"), 1)  # there are no curves


if __name__ == "__main__":
    unittest.main()

"""What `tandem plot` leaves in a folder: figures, the report, messages and exit status."""

import contextlib
import io
import json
import re
import unittest
import xml.etree.ElementTree as xml

import numpy as np

from support import CONTACT, KP, RDP, VC, FolderTest, site_csv

import benches
from canvas import Sheet, nice_step, span
from command import main
from page import table
from run_figures import contact_stretches, recorded_time
from table import Table


def plot(*folders, program=""):
    """Exit status, standard output and standard error."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        status = main(["runs", f"{VC},{KP},{RDP}", program, *folders])
    return status, out.getvalue(), err.getvalue()


class ReportTest(FolderTest):
    def test_draws_cooperation_contact_and_sweeps(self):
        folders = [self.make_run_folder(f"{scheme}-{damping}", scheme,
                                        scenario__device__damping=damping)
                   for scheme in (RDP, KP, VC) for damping in (0.5, 1)]
        folders.append(self.make_run_folder("contact", RDP, CONTACT))
        self.assertEqual(plot(*folders), (0, f"{folders[0]}/report.html\n", ""))
        figures = self.folder / f"{RDP}-0.5/figures"
        self.assertEqual(sorted(path.name for path in figures.iterdir()), sorted(
            f"{name}.{kind}" for kind in ("svg", "png")
            for name in ("cooperation-coherency", "cooperation-coherency-over-time",
                         "cooperation-motion", "contact-motion", "sweep")))
        for path in figures.glob("*.svg"):
            self.assertEqual(xml.parse(path).getroot().get("width"), "675pt")  # 900 px
        report = (figures.parent / "report.html").read_text()
        self.assertEqual(report.count("<figure"), 5)
        self.assertNotRegex(report, r'(src|href)="(?!data:|#)')  # nothing from elsewhere
        for text in ("What was found", "the paper’s order", "10.94", "contact changes"):
            self.assertIn(text, report)

    def test_equal_runs_give_equal_files(self):
        one, other = (self.make_run_folder(f"{name}/run") for name in "ab")
        self.assertEqual((plot(one)[0], plot(other)[0]), (0, 0))
        files = [path for path in (self.folder / "a").rglob("*") if path.is_file()]
        self.assertEqual(len(files), 3 + 1 + 4)
        for path in files:
            twin = self.folder / "b" / path.relative_to(self.folder / "a")
            self.assertEqual(path.read_bytes(), twin.read_bytes(), path.name)

    def test_draws_a_playground(self):
        body = {"shape": "box", "half_extents": [0.1, 0.1, 0.1]}
        folder = self.make_run_folder(
            "play", RDP, "playground", title="Boxes & <more>",
            scene={"bodies": [body | {"site": site, "role": "object"} for site in (1, 2)]})
        self.write("play/scene.csv", "t,site,body,x,y,z,qw,qx,qy,qz\n" + "".join(
            f"{t},{b + 1},{b},{t},0,0,1,0,0,0\n" for t in (0, 0.5, 1) for b in (0, 1)))
        self.assertEqual(plot(folder)[0], 0)
        names = {path.name for path in (self.folder / "play/figures").iterdir()}
        self.assertLessEqual({"playground-top-view.svg", "playground-motion.png"}, names)
        report = (self.folder / "play/report.html").read_text()
        self.assertIn("<title>Tandem: Boxes &amp; &lt;more&gt;</title>", report)

    def test_films_that_cannot_be_drawn_are_left_out_with_one_note(self):
        body = {"shape": "box", "half_extents": [0.1, 0.1, 0.1], "site": 1, "role": "object"}
        folders = [self.make_run_folder(name, RDP, "playground", scene={"bodies": [body]})
                   for name in ("a", "b")]
        for name in ("a", "b"):
            self.write(f"{name}/scene.csv", "t,site,body,x,y,z,qw,qx,qy,qz\n0,1,0,0,0,0,1,0,0,0\n"
                       "1,1,0,1,0,0,1,0,0,0\n")
        status, _, err = plot(*folders, program="/bin/false")
        self.assertEqual((status, err),
                         (0, "tandem: note: the report has no films: /bin/false broke off\n"))
        self.assertNotIn("image/gif", (self.folder / "a/report.html").read_text())

    def test_sets_a_live_run_beside_its_twin(self):
        virtual = self.make_run_folder("virtual")
        whole = json.loads((self.folder / "virtual/summary.json").read_text())
        for site in (1, 2):
            self.write(f"live/site{site}.json", {
                "scenario": whole["scenario"], "scalar": "float64", f"site{site}": whole["site1"],
                "network": {"round_trip": 0.1}, "loop": {"ticks": 10, "late": 1}})
            self.write(f"live/site{site}.csv", site_csv())
        self.assertEqual(plot(virtual, str(self.folder / "live"))[0], 0)
        report = (self.folder / "virtual/report.html").read_text()
        self.assertIn("Live beside virtual time", report)
        self.assertIn("-100.0", report)  # no distance live
        self.assertTrue((self.folder / "virtual/figures/live-1.svg").exists())

    def test_old_pictures_go_and_other_files_stay(self):
        folder = self.make_run_folder("run")
        old, own = self.write("run/figures/old.svg", "<svg/>"), self.write("run/figures/own", "")
        self.assertEqual(plot(folder, folder + "/")[0], 0)
        names = {path.name for path in (self.folder / "run/figures").iterdir()}
        self.assertNotIn("old.svg", names, old)
        self.assertIn("own", names, own)

    def test_bad_input_is_one_line_and_leaves_what_was_there(self):
        folder = self.make_run_folder("run")
        self.write("run/figures/old.svg", "<svg/>")
        self.write("run/site2.csv", "t,object_x\n0,one\n")
        status, out, err = plot(folder)
        self.assertEqual((status, out), (2, ""))
        self.assertEqual(err, f"tandem: {folder}/site2.csv: line 2, column \"object_x\": \"one\" "
                         "is not a number\n")
        self.assertEqual(sorted(path.name for path in (self.folder / "run").iterdir()),
                         ["figures", "site1.csv", "site2.csv", "summary.json"])
        missing = plot(str(self.folder / "no\nrun"))
        self.assertEqual((missing[0], missing[1], missing[2].count("\n")), (2, "", 1))
        self.assertIn("no?run/summary.json: cannot be read", missing[2])

    def test_a_disk_that_refuses_is_status_1(self):
        folder = self.make_run_folder("run")
        self.write("run/figures", "a file where the folder should be")
        status, out, err = plot(folder)
        self.assertEqual((status, out, err.count("\n")), (1, "", 1))
        self.assertIn("run/figures: ", err)


class BenchTest(FolderTest):
    def test_accuracy_has_a_panel_for_each_scene_with_points(self):
        def run(method, error, **more):
            return {"method": method, "host_rate": 60, "status": "good", "us_per_second": 1e3,
                    "errors": {"tool": error, "body": 0, "force": 0}} | more
        bench = {"format": "tandem-bench-accuracy", "scenes": [
            {"title": "a", "runs": [run("plugin handoff", 1e-9), run("a new one", 1e-3)]},
            {"title": "b", "runs": [run("ODE", 0), run("ODE", 1, status="diverged")]}]}
        figures = benches.bench_figures(self.write("accuracy.json", bench))
        self.assertEqual([figure.name for figure in figures], ["accuracy"])  # no force is wrong
        sheet = Sheet("", figures[0].height)
        figures[0].paint(sheet)
        self.assertEqual([axes.get_title() for axes in sheet.drawing.axes], ["a"])
        self.assertEqual(len(sheet.drawing.axes[0].lines), 2)

    def test_stability_paints_the_cells(self):
        bench = {"format": "tandem-bench-stress", "maps": [
            {"method": "force injection", "stiffness": [10, 100], "host_rates": [30, 60, 120],
             "cells": [["stable"] * 3, ["grows", "not_finite", "not_applicable"]],
             "step_limit": [0.02, 0.01]}]}
        path = self.write("stress.json", bench)
        self.assertEqual(main(["bench", path]), 0)
        self.assertTrue((self.folder / "stability.png").exists())


class ArithmeticTest(unittest.TestCase):
    def test_contact_stretches_cover_their_last_tick(self):
        stretches = contact_stretches(Table("t,contact\n0,0\n1,1\n2,1\n3,0\n4,1\n", "site1.csv"))
        self.assertEqual(stretches, [(1, 2), (4, 1)])
        self.assertEqual(recorded_time(np.array([0.0, 0.5, 1.0])), (0, 1.5))

    def test_steps_and_limits_are_round(self):
        self.assertEqual([nice_step(size, 5) for size in (5, 7, 24, 0.9)], [1, 2, 5, 0.2])
        self.assertEqual(span([1, np.nan, 3], share=0.5), (0, 4))
        self.assertEqual(span([2.0], least=1), (1.5, 2.5))
        self.assertEqual(span([np.nan]), (0, 1))

    def test_columns_of_numbers_stand_right(self):
        html = table(["a", "b"], [["1.5", "x"], ["–<span>2</span>", "3"]])
        self.assertEqual(len(re.findall('<td class="n">', html)), 2)


if __name__ == "__main__":
    unittest.main()

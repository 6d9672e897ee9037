"""How `tandem plot` reads runs and sorts them: summaries, groups, sweeps, the paper's outcomes."""

import math
import random
import unittest

from support import CONTACT, KP, RDP, VC, FolderTest, message_of, run_of, summary

import findings
from grouping import Grouping
from paper import paper_outcome
from runs import COOPERATION, load_run, parse_object
from words import join_words, number_text


class RunTest(unittest.TestCase):
    def test_takes_numbers_from_the_summary(self):
        run = run_of(name="runs/first")
        self.assertEqual((run.kind, run.title), (COOPERATION, "first"))
        self.assertEqual(run.number("coherency.mean_abs"), 0.006)
        self.assertEqual(run.number("site2.contact_transitions"), 3)
        self.assertEqual(run.setting("network.delay"), 0.05)
        self.assertEqual(run.setting("experiment.axis.0"), 1)
        self.assertTrue(math.isnan(run.setting("no.such.key")))

    def test_names_file_and_key_of_what_is_broken(self):
        for changes, message in [
                ({"scenario__experiment__scheme": None},
                 '"scenario.experiment.scheme" is missing'),
                ({"coherency__mean_abs": None}, '"coherency.mean_abs" is missing'),
                ({"coherency__mean_abs": "small"}, '"coherency.mean_abs" must be a number'),
                ({"site1": 3}, '"site1.contact_transitions" is missing'),
                ({"scene": {"bodies": 7}}, '"scene.bodies" must be a list'),
                ({"scene": {"bodies": [{"site": 1, "role": "object", "shape": "cone"}]}},
                 '"scene.bodies.0.shape" is "cone"; allowed are box and sphere'),
                ({"scenario__experiment__scheme": "no_proxy"},
                 '"scenario.experiment.scheme" is "no_proxy"; allowed are virtual_coupling, '
                 'kinematic_proxy and remote_dynamic_proxy')]:
            with self.subTest(message):
                self.assertEqual(message_of(lambda: run_of(**changes)),
                                 f"run/summary.json: key {message}")

    def test_refuses_what_is_no_json_object(self):
        for text in ('{"scenario":', "[]", "", "{\"a\": NaN}", "[" * 100000):
            self.assertEqual(message_of(lambda: parse_object(text, "a.json")),
                             "a.json: not a JSON object")


class GroupingTest(unittest.TestCase):
    def test_schemes_of_equal_settings_are_one_group_in_one_order(self):
        runs = [run_of(scheme) for scheme in (RDP, VC, KP)]
        for _ in range(3):
            runs.append(runs.pop(0))
            grouping = Grouping(runs)
            (group,) = grouping.groups[COOPERATION]
            self.assertEqual([run.scheme for run in group.runs], [VC, KP, RDP])
            self.assertEqual((group.difference, grouping.sweeps), ("", []))

    def test_titles_and_spellings_of_numbers_do_not_count(self):
        runs = [run_of(), run_of(scenario__name="Second", scenario__contact__stiffness=4000.0)]
        (group,) = Grouping(runs).groups[COOPERATION]
        self.assertEqual(group.runs, runs[:1])

    def test_names_what_tells_cases_apart(self):
        runs = [run_of(KP, CONTACT), run_of(KP, CONTACT, scenario__network__delay=0.2),
                run_of(KP, CONTACT, scenario__contact__stiffness=4000)]
        self.assertEqual([group.difference for group in Grouping(runs).groups[runs[0].kind]],
                         ["contact stiffness 2000 N/m, network delay 0.1 s",
                          "contact stiffness 2000 N/m, network delay 0.2 s",
                          "contact stiffness 4000 N/m, network delay 0.1 s"])

    def test_a_sweep_shows_the_papers_point_in_detail(self):
        runs = [run_of(scheme, scenario__device__damping=damping)
                for damping in (2.0, 0.0, 0.5) for scheme in (KP, RDP)]
        grouping = Grouping([*runs, run_of(RDP, CONTACT)])
        (sweep,) = grouping.sweeps
        self.assertEqual([point.damping for point in sweep.points], [0, 0.5, 2])
        (group,) = grouping.groups[COOPERATION]
        self.assertEqual(group.damping, 0.5)

    def test_a_sweep_without_the_papers_point_shows_the_first_given(self):
        runs = [run_of(scenario__device__damping=damping) for damping in (2.0, 0.25, 1.0)]
        (group,) = Grouping(runs).groups[COOPERATION]
        self.assertIs(group.first, runs[0])


class PaperTest(unittest.TestCase):
    def test_applies_to_the_papers_settings_only(self):
        self.assertEqual(paper_outcome(run_of(VC))["coherency.mean_abs"], 10.94e-3)
        self.assertEqual(paper_outcome(run_of(RDP, CONTACT))["site1.device_end"], 0.1919)
        for changes in ({"scenario__device__damping": 1.0}, {"scenario__network__loss": 0.01},
                        {"scenario__site1__hand": "minimum_jerk"},
                        {"scenario__network__delay": 0.06}):
            self.assertEqual(paper_outcome(run_of(VC, **changes)), {}, changes)


class FindingsTest(unittest.TestCase):
    def test_order_comes_from_the_numbers(self):
        runs = [run_of(scheme, coherency__mean_abs=error,
                       site2__coherency__received_mean=0.01 - error)
                for scheme, error in ((VC, 0.011), (KP, 0.003), (RDP, 0.006))]
        (group,) = Grouping(runs).groups[COOPERATION]
        order = findings.Order(group, "at equal time")
        self.assertTrue(order.is_the_papers)
        self.assertEqual(order.text, "virtual coupling (11.0 mm) > remote dynamic proxy (6.00 mm) "
                         "> kinematic proxy (3.00 mm)")
        self.assertFalse(findings.Order(group, "as received at site 2").is_the_papers)
        self.assertIn("&gt;", findings.coherency_findings(group)[0])

    def test_a_sweep_says_where_contact_is_intermittent(self):
        runs = [run_of(KP, CONTACT, scenario__device__damping=damping,
                       site1__contact_transitions=changes)
                for damping, changes in ((0.0, 103), (0.5, 20), (1.0, 19))]
        self.assertEqual(findings.sweep_findings(Grouping(runs).sweeps[0]),
                         ["Kinematic proxy: contact is intermittent (20 changes or more) only at "
                          "b_dev = 0 and 0.5 N s/m."])

    def test_contact_over_all_cases(self):
        runs = [run_of(KP, CONTACT, scenario__network__delay=0.1 * (1 + i),
                       site1__contact_transitions=changes) for i, changes in enumerate((25, 1, 0))]
        self.assertEqual(findings.contact_findings(Grouping(runs).groups[runs[0].kind]),
                         ["User-to-user contact, kinematic proxy: intermittent in 1 of 3 cases, "
                          "kept after the first touch in 1 of 3 cases and no contact in 1 of 3 "
                          "cases (0 to 25 changes)."])

    def test_words(self):
        self.assertEqual([join_words(list("abc")[:n]) for n in range(4)],
                         ["", "a", "a and b", "a, b and c"])
        self.assertEqual([number_text(value) for value in (0, 12.345, 0.5814, 1234.5, math.nan)],
                         ["0", "12.3", "0.581", "1234", "–"])
        numbers = random.Random(3)
        for _ in range(300):
            value = 10 ** numbers.uniform(-6, 6)
            self.assertAlmostEqual(float(number_text(value)) / value, 1, delta=0.0051)


class LiveTest(FolderTest):
    def setUp(self):
        super().setUp()
        for site, late, x in ((1, 3, 0.002), (2, 1, 0.001)):
            self.write(f"site{site}.json", self.site_json(site, late))
            self.write(f"site{site}.csv", "t,object_x,object_y,object_z\n"
                       f"0,{x},0,0\n0.001,{3 * x},0,0\n")

    @staticmethod
    def site_json(site, late):
        return {"scenario": {"experiment": {"kind": "cooperative_manipulation", "scheme": KP},
                             "network": {"delay": 0.05}},
                "scalar": "float64", "network": {"round_trip": 0.102},
                f"site{site}": {"contact_transitions": site, "force": {"max": 5.0, "mean": 2.0}},
                "loop": {"ticks": 100, "late": late}}

    def test_joins_what_both_sites_know(self):
        run = load_run(str(self.folder))
        self.assertAlmostEqual(run.number("network.round_trip"), 0.102)
        self.assertAlmostEqual(run.number("loop.late_share"), 0.02)
        self.assertAlmostEqual(run.number("coherency.mean_abs"), 0.002)
        self.assertAlmostEqual(run.number("coherency.max_abs"), 0.003)
        self.assertEqual([run.number(f"site{site}.contact_transitions") for site in (1, 2)], [1, 2])

    def test_is_no_run_in_virtual_time(self):
        self.assertEqual(Grouping([load_run(str(self.folder))]).groups[COOPERATION], [])
        self.write("summary.json", summary())
        self.assertFalse(load_run(str(self.folder)).is_live)

    def test_two_scenarios_in_one_folder_are_refused(self):
        other = self.site_json(2, 0)
        other["scenario"]["device"] = {"damping": 1.0}  # its own business
        self.write("site2.json", other)
        self.assertTrue(load_run(str(self.folder)).is_live)
        other["scenario"]["object"] = {"mass": 0.3}
        self.write("site2.json", other)
        self.assertIn("site2.json: another scenario",
                      message_of(lambda: load_run(str(self.folder))))

    def test_half_a_run_is_refused_by_name(self):
        (self.folder / "site2.json").unlink()
        self.assertIn("site2.json: cannot", message_of(lambda: load_run(str(self.folder))))
        self.write("site2.json", [])
        self.assertIn("site2.json: not a", message_of(lambda: load_run(str(self.folder))))


if __name__ == "__main__":
    unittest.main()

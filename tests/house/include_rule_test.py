#!/usr/bin/env python3
"""What include_rule.py must catch, and what it must leave alone, on small trees made for it."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import include_rule

PUBLIC_HEADERS = {f"{library}/include/tandem/{library}/{library}.h": "#pragma once\n"
                  for library in include_rule.LIBRARIES}


def breaks_of(files):
    """Breaks in a tree of the given files, and a public header in each library."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in {**PUBLIC_HEADERS, **files}.items():
            path = Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return include_rule.House(folder).breaks()


def run_main(arguments):
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()):
        return include_rule.main(arguments), out.getvalue()


class IncludeRuleTest(unittest.TestCase):
    def assert_broken(self, file, include, words):
        found = breaks_of({file: f"// first line\n#include {include}\n"})
        self.assertEqual(len(found), 1, f"{file}: {include}")
        self.assertEqual((str(found[0].file), found[0].line), (file, 2))
        self.assertIn(words, found[0].rule)

    def assert_kept(self, file, include, **others):
        self.assertEqual(breaks_of({file: f"#include {include}\n", **others}), [], f"{file}: {include}")

    def test_arrows_of_the_house(self):
        allowed = {"coordination": (), "bullet_bridge": ("coordination",), "falcon": ("coordination",),
                   "plugin": ("coordination", "bullet_bridge", "falcon"),
                   "demos": include_rule.LIBRARIES, "bench": include_rule.LIBRARIES,
                   "tests": include_rule.LIBRARIES}
        for folder, owners in allowed.items():
            for owner in include_rule.LIBRARIES:
                for include in (f'"tandem/{owner}/{owner}.h"', f"<tandem/{owner}/{owner}.h>"):
                    with self.subTest(folder=folder, include=include):
                        if owner == folder or owner in owners:
                            self.assert_kept(f"{folder}/src/a.cpp", include)
                        else:
                            self.assert_broken(f"{folder}/src/a.cpp", include, f"may not include {owner}/")

    def test_front_doors_are_their_librarys(self):
        door = {"plugin/include/tandem/tandem.h": "#pragma once\n"}
        for folder in ("plugin", "demos", "tests"):
            self.assert_kept(f"{folder}/src/a.cpp", '"tandem/tandem.h"', **door)
        for folder in ("coordination", "bullet_bridge", "falcon"):
            found = breaks_of({f"{folder}/src/a.cpp": '#include "tandem/tandem.h"\n', **door})
            self.assertEqual([breach.rule for breach in found], [f"{folder}/ may not include plugin/"])
        self.assert_broken("plugin/src/a.cpp", '"tandem/window.h"', "has no such header")

    def test_bullet_is_for_the_bridge(self):
        headers = ("<btBulletDynamicsCommon.h>", "<LinearMath/btScalar.h>",
                   "<BulletDynamics/Dynamics/btRigidBody.h>", "<bullet/LinearMath/btVector3.h>",
                   '"BulletCollision/CollisionShapes/btBoxShape.h"')
        for header in headers:
            for folder in ("coordination", "falcon", "plugin"):
                self.assert_broken(f"{folder}/src/a.cpp", header, "only library folder with Bullet")
            for folder in ("bullet_bridge", "demos", "tests"):
                self.assert_kept(f"{folder}/src/a.cpp", header)

    def test_coordination_has_no_outside_world(self):
        for header, word in (("thread", "thread"), ("mutex", "thread"), ("chrono", "clock"),
                             ("fstream", "file"), ("filesystem", "file"), ("sys/socket.h", "socket"),
                             ("netinet/in.h", "socket")):
            self.assert_broken("coordination/src/a.cpp", f"<{header}>", f"has no {word}")
            self.assert_broken("coordination/include/tandem/coordination/a.h", f"<{header}>", f"has no {word}")
        for header in ("vector", "cmath", "Eigen/Core", "unsupported/Eigen/MatrixFunctions", "thread_pool.h"):
            self.assert_kept("coordination/src/a.cpp", f"<{header}>")

    def test_bridge_has_no_thread_of_its_own(self):
        self.assert_broken("bullet_bridge/src/a.cpp", "<thread>", "has no thread")
        self.assert_broken("bullet_bridge/src/a.cpp", "<chrono>", "has no clock")
        self.assert_kept("bullet_bridge/src/a.cpp", "<mutex>")

    def test_dependencies_stay_in_their_folder(self):
        for file, header in (("coordination/src/a.cpp", "fmt/format.h"), ("plugin/src/a.cpp", "nlohmann/json.hpp"),
                             ("bullet_bridge/src/a.cpp", "hidapi/hidapi.h"), ("demos/program/a.cpp", "gtest/gtest.h"),
                             ("falcon/src/a.cpp", "sodium.h")):
            self.assert_broken(file, f"<{header}>", "may not use")
        self.assert_kept("falcon/src/a.cpp", "<hidapi/hidapi.h>")
        self.assert_kept("falcon/src/a.cpp", "<libftdi1/ftdi.h>")
        self.assert_kept("plugin/src/a.cpp", "<sodium.h>")
        self.assert_kept("demos/program/a.cpp", "<toml++/toml.h>")

    def test_private_headers_stay_private(self):
        inner = {"falcon/src/inner.h": ""}
        for include in ('"inner.h"', '"../../falcon/src/inner.h"'):
            found = breaks_of({"demos/program/a.cpp": f"#include {include}\n", **inner})
            self.assertEqual([b.rule[:24] for b in found], ["falcon's private header:"])
            self.assertEqual(breaks_of({"tests/unit/a.cpp": f"#include {include}\n", **inner}), [])
        self.assertEqual(breaks_of({"falcon/src/deeper/a.cpp": '#include "inner.h"\n', **inner}), [])

    def test_public_header_includes_no_private_one(self):
        found = breaks_of({"falcon/include/tandem/falcon/a.h": '#include "inner.h"\n', "falcon/src/inner.h": ""})
        self.assertIn("public headers only", found[0].rule)

    def test_demos_are_for_bench_and_tests_only(self):
        demo = {"demos/program/world/scene.h": ""}
        found = breaks_of({"plugin/src/a.cpp": '#include "demos/program/world/scene.h"\n', **demo})
        self.assertIn("nothing but bench/ and tests/ includes demos/", found[0].rule)
        for file in ("bench/speed/a.cpp", "tests/unit/a.cpp"):
            self.assertEqual(breaks_of({file: '#include "demos/program/world/scene.h"\n', **demo}), [])
        self.assertEqual(breaks_of({"demos/program/run/a.cpp": '#include "world/scene.h"\n', **demo}), [])
        found = breaks_of({"bench/speed/a.cpp": '#include "world/scene.h"\n', **demo})
        self.assertIn('is included as "demos/program/..."', found[0].rule)

    def test_bench_sees_libraries_and_is_for_tests_only(self):
        inner = {"bench/scenes/b.h": "", "falcon/src/inner.h": ""}
        self.assertEqual(breaks_of({"bench/speed/a.cpp": '#include "bench/scenes/b.h"\n', **inner}), [])
        self.assertEqual(breaks_of({"bench/speed/a.cpp": '#include "falcon/src/inner.h"\n', **inner}), [])
        found = breaks_of({"bench/speed/a.cpp": '#include "inner.h"\n', **inner})
        self.assertIn('is included as "falcon/src/..."', found[0].rule)
        self.assertEqual(breaks_of({"tests/unit/a.cpp": '#include "bench/scenes/b.h"\n', **inner}), [])
        found = breaks_of({"plugin/src/a.cpp": '#include "bench/scenes/b.h"\n', **inner})
        self.assertIn("nothing but tests/ includes bench/", found[0].rule)
        self.assert_kept("bench/reference/a.cpp", "<boost/numeric/odeint.hpp>")
        self.assert_broken("demos/program/a.cpp", "<boost/numeric/odeint.hpp>", "may not use Boost")

    def test_only_the_view_has_graphics(self):
        for header in ("<GLFW/glfw3.h>", "<imgui.h>", "<EGL/egl.h>", "<stb_image_write.h>"):
            self.assert_kept("demos/view/window/a.cpp", header)
            self.assert_broken("demos/program/run/a.cpp", header, "demos/ may not use")
        inner = {"demos/program/world/scene.h": "", "demos/view/gl/b.h": ""}
        for include in ('"world/scene.h"', '"gl/b.h"'):
            self.assertEqual(breaks_of({"demos/view/film/a.cpp": f"#include {include}\n", **inner}), [])
        found = breaks_of({"demos/program/run/a.cpp": '#include "gl/b.h"\n', **inner})
        self.assertIn("nothing but tests/ includes demos/view/", found[0].rule)
        door = {"demos/view/window/window.h": ""}
        self.assertEqual(breaks_of({"demos/hosts/a.cpp": '#include "window/window.h"\n', **door}), [])

    def test_adaptors_may_read_bullet_and_files_but_no_private_headers(self):
        adaptor = "plugin/doors/preload/a.cpp"
        for include in ("<toml++/toml.h>", "<BulletDynamics/Dynamics/btRigidBody.h>", '"tandem/plugin/plugin.h"',
                        '"tandem/falcon/falcon.h"'):
            self.assert_kept(adaptor, include)
        self.assert_broken("plugin/src/a.cpp", "<toml++/toml.h>", "may not use toml++")
        self.assert_kept(adaptor, '"preload/inner/b.h"', **{"plugin/doors/preload/inner/b.h": ""})
        self.assert_kept("tests/a.cpp", '"preload/inner/b.h"', **{"plugin/doors/preload/inner/b.h": ""})
        self.assert_broken(adaptor, "<fmt/format.h>", "may not use fmt")
        found = breaks_of({adaptor: '#include "site_impl.h"\n', "plugin/src/site_impl.h": ""})
        self.assertIn("plugin's private header", found[0].rule)
        found = breaks_of({"plugin/src/a.cpp": '#include "preload/b.h"\n', "plugin/doors/preload/b.h": ""})
        self.assertIn("nothing but tests/ includes plugin/doors", found[0].rule)

    def test_the_c_door_is_part_of_the_plugin(self):
        inner = {"plugin/src/live/b.h": "", "plugin/doors/c/d.h": ""}
        self.assertEqual(breaks_of({"plugin/doors/c/a.cpp": '#include "live/b.h"\n#include "c/d.h"\n', **inner}), [])

    def test_libraries_reach_into_those_below_by_full_path(self):
        inner = {"bullet_bridge/src/b.h": "", "plugin/src/c.h": ""}
        self.assertEqual(breaks_of({"plugin/src/a.cpp": '#include "bullet_bridge/src/b.h"\n', **inner}), [])
        found = breaks_of({"plugin/src/a.cpp": '#include "b.h"\n', **inner})
        self.assertIn('is included as "bullet_bridge/src/..."', found[0].rule)
        found = breaks_of({"falcon/src/a.cpp": '#include "plugin/src/c.h"\n', **inner})
        self.assertIn("falcon/ may not include plugin/", found[0].rule)
        found = breaks_of({"plugin/doors/preload/a.cpp": '#include "plugin/src/c.h"\n', **inner})
        self.assertIn("plugin's private header", found[0].rule)

    def test_doors_share_the_c_doors_words(self):
        for header, allowed in (("site_words.h", True), ("values.h", False)):
            found = breaks_of({"plugin/doors/pybullet/a.cpp": f'#include "c/{header}"\n',
                               f"plugin/doors/c/{header}": ""})
            self.assertEqual(not found, allowed, header)

    def test_programs_may_take_the_dds_door_alone(self):
        for header, allowed in (("dds_carrier.h", True), ("participant.h", False)):
            found = breaks_of({"demos/program/a.cpp": f'#include "plugin/doors/dds/{header}"\n',
                               f"plugin/doors/dds/{header}": ""})
            self.assertEqual(not found, allowed, header)
        self.assert_broken("demos/program/a.cpp", "<dds/dds.h>", "demos/ may not use Cyclone DDS")
        self.assert_kept("plugin/doors/dds/a.cpp", "<dds/dds.h>")

    def test_headers_that_are_not_there(self):
        self.assert_broken("plugin/src/a.cpp", '"nowhere.h"', "no such header")
        self.assert_broken("plugin/src/a.cpp", '"tandem/falcon/nowhere.h"', "falcon/include has no such header")
        self.assert_broken("plugin/src/a.cpp", '"tandem/bridge/a.h"', "no library folder bridge/")

    def test_comments_are_no_includes(self):
        self.assertEqual(breaks_of({"coordination/src/a.cpp": "// #include <thread>\n"}), [])
        self.assert_broken("coordination/src/a.cpp", "<thread>  // for later", "has no thread")

    def test_spaces_do_not_hide_an_include(self):
        found = breaks_of({"coordination/src/a.cpp": "  #  include<thread>\n"})
        self.assertEqual(len(found), 1)

    def test_program_says_file_line_and_rule(self):
        with tempfile.TemporaryDirectory() as folder:
            source = Path(folder, "coordination", "src")
            source.mkdir(parents=True)
            Path(source, "a.cpp").write_text("#include <vector>\n", encoding="utf-8")
            self.assertEqual(run_main([folder]), (0, "1 files, 0 broken include rules\n"))
            Path(source, "a.cpp").write_text("\n#include <thread>\n", encoding="utf-8")
            status, text = run_main([folder])
            self.assertEqual(status, 1)
            self.assertIn("coordination/src/a.cpp:2: #include thread: coordination/ has no thread\n", text)

    def test_program_refuses_a_wrong_folder(self):
        self.assertEqual(run_main([])[0], 2)
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(run_main([folder])[0], 2)


if __name__ == "__main__":
    unittest.main()

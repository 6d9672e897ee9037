#!/usr/bin/env python3
"""The plugin in the real PyBullet. Where there is none: "SKIPPED", and exit status 77.

    PYTHONPATH=folder/of/tandem_pybullet.py real_pybullet.py
"""

import itertools
import math
import os
import sys
import tempfile
import unittest
import warnings

try:
    import pybullet as p
except ImportError as why:
    print(f"SKIPPED: no PyBullet to test with ({why})")
    sys.exit(77)

import tandem_pybullet as tandem

AT_REST = tandem.State((0, 0, 0), (0, 0, 0, 1), (0, 0, 0), (0, 0, 0))
HALF = (0.02, 0.02, 0.02)


def ringing(x0, t):
    """m x'' + B x' + K x = 0 from x0 at rest, K = 2000, B = 10, m = 0.1."""
    c = 10 / 0.2
    w = math.sqrt(2000 / 0.1 - c * c)
    return x0 * math.exp(-c * t) * (math.cos(w * t) + c / w * math.sin(w * t))


class Client:
    """A physics client with a step, sub-steps and gravity; a context manager."""

    def __init__(self, rate=240, substeps=0, gravity=0.0):
        self.id = p.connect(p.DIRECT)
        p.setTimeStep(1 / rate, physicsClientId=self.id)
        p.setPhysicsEngineParameter(numSubSteps=substeps, physicsClientId=self.id)
        p.setGravity(0, 0, gravity, physicsClientId=self.id)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        p.disconnect(self.id)

    def add_cube(self, position=(0, 0, 0), maximal=False, half=HALF, mass=0.2):
        shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=half, physicsClientId=self.id)
        return p.createMultiBody(mass, shape, basePosition=position, physicsClientId=self.id,
                                 useMaximalCoordinates=maximal)

    def add_floor(self):
        shape = p.createCollisionShape(p.GEOM_PLANE, physicsClientId=self.id)
        return p.createMultiBody(0, shape, physicsClientId=self.id)

    def position(self, body):
        return p.getBasePositionAndOrientation(body, physicsClientId=self.id)[0]

    def velocity(self, body):
        return p.getBaseVelocity(body, physicsClientId=self.id)

    def dynamics(self, body):
        return p.getDynamicsInfo(body, -1, physicsClientId=self.id)


def far_hand():
    return tandem.Device(start=(10, 0, 0))


class FreeCoupler(unittest.TestCase):
    def test_is_the_closed_form(self):
        """1e-6 m is asked for; what is measured is rounding."""
        for maximal, rate, substeps, gravity in itertools.product((False, True), (240, 60),
                                                                  (0, 1, 4, 16), (0.0, -9.81)):
            with self.subTest(maximal=maximal, rate=rate, substeps=substeps, gravity=gravity), \
                    Client(rate, substeps, gravity) as client:
                worst = self.find_worst(client, maximal, rate)
                print(f"free coupler, maximal={maximal:d} 1/{rate} s x {substeps:2} "
                      f"g={gravity}: {worst:.1e} m")
                self.assertLess(worst, 1e-10)

    @staticmethod
    def find_worst(client, maximal, rate):
        cube = client.add_cube((0.01, 0, 0), maximal)
        with tandem.Site(far_hand(), client=client.id, coordination=(2000, 10),
                         link_loss=False) as site:
            site.share(cube, shape=("box", HALF) if maximal else None)
            link = site.manual_link()
            site.connect(2, link, start=(-5, 0, 0))
            link.push(tandem.Packet(2, False, 0, 0.0, (-5, 0, 0), (0, 0, 0), math.nan, math.nan,
                                    [(0, AT_REST)]))
            worst = 0.0
            for step in range(1, rate // 2):
                site.step()
                worst = max(worst, abs(client.position(cube)[0] - ringing(0.01, step / rate)))
            return worst


class Bodies(unittest.TestCase):
    def test_are_given_back(self):
        for maximal in (False, True):
            with self.subTest(maximal=maximal), Client(gravity=-9.81) as client:
                brick, other = (client.add_cube((0, y, 1), maximal, (0.05, 0.02, 0.01))
                                for y in (0, 1))
                before = client.dynamics(brick)
                site = tandem.Site(far_hand(), peers=2, client=client.id)
                site.share(brick, shape=("box", (0.05, 0.02, 0.01)))
                self.assertAlmostEqual(client.dynamics(brick)[0], before[0] / 2)
                for _ in range(24):
                    site.step()
                site.close()
                after = client.dynamics(brick)
                for place in (0, 2):  # mass, inertia
                    self.assertEqual(after[place], before[place])
                for body in (brick, other):  # damping acts again as in one that was not shared
                    p.resetBasePositionAndOrientation(body, (0, body, 5), (0, 0, 0, 1),
                                                      physicsClientId=client.id)
                    p.resetBaseVelocity(body, (1, 0, 0), (0, 0, 1), physicsClientId=client.id)
                for _ in range(120):
                    p.stepSimulation(physicsClientId=client.id)
                self.assertEqual(client.velocity(brick), client.velocity(other))

    def test_tumble_as_free_bodies(self):
        """The engine's own gyroscopic term, of either kind, is neither lost nor counted twice."""
        for maximal, rate in itertools.product((False, True), (60, 240)):
            with self.subTest(maximal=maximal, rate=rate), Client(rate) as client:
                brick = client.add_cube((0, 0, 0), maximal, (0.05, 0.02, 0.01))
                p.resetBaseVelocity(brick, (0, 0, 0), (1, 6, 0.5), physicsClientId=client.id)
                with tandem.Site(far_hand(), peers=1, client=client.id) as site:
                    site.share(brick, shape=("box", (0.05, 0.02, 0.01)))
                    before = self.momentum(client, brick)
                    for _ in range(rate):
                        site.step()
                    after = self.momentum(client, brick)
                lost = math.dist(before, after) / math.hypot(*before)
                print(f"tumbling brick, maximal={maximal:d} 1/{rate} s: {lost:.1e} of its angular "
                      "momentum lost in 1 s")
                self.assertLess(lost, 1e-5)

    @staticmethod
    def momentum(client, body):
        turned = p.getBasePositionAndOrientation(body, physicsClientId=client.id)[1]
        R = p.getMatrixFromQuaternion(turned)
        w = client.velocity(body)[1]
        inertia = client.dynamics(body)[2]
        local = [inertia[i] * sum(R[3 * j + i] * w[j] for j in range(3)) for i in range(3)]
        return [sum(R[3 * i + j] * local[j] for j in range(3)) for i in range(3)]

    def test_meet_once(self):
        """Shared cubes that stand on each other: contact is Tandem's alone, until the end."""
        with Client(gravity=-9.81) as client:
            low, high = client.add_cube((0, 0, 0.0205)), client.add_cube((0.003, 0, 0.0615))
            client.add_floor()
            for _ in range(60):  # so that they touch in PyBullet before
                p.stepSimulation(physicsClientId=client.id)
            self.assertGreater(len(p.getContactPoints(low, high, physicsClientId=client.id)), 0)
            with tandem.Site(far_hand(), peers=1, client=client.id) as site:
                site.share(low)
                site.share(high)
                site.obstacles()
                for _ in range(120):
                    site.step()
                    self.assertEqual(p.getContactPoints(physicsClientId=client.id), ())
                self.assertAlmostEqual(client.position(high)[2], 0.06, delta=1e-3)
            for _ in range(2):
                p.stepSimulation(physicsClientId=client.id)
            self.assertGreater(len(p.getContactPoints(low, high, physicsClientId=client.id)), 0)

    def test_push_what_is_pybullets(self):
        """A shared cube runs into another that PyBullet alone knows: momentum is kept."""
        with Client() as client:
            cube, other = client.add_cube((0, 0, 0)), client.add_cube((0.1, 0, 0), mass=0.1)
            p.changeDynamics(other, -1, linearDamping=0, angularDamping=0,
                             physicsClientId=client.id)
            with tandem.Site(far_hand(), client=client.id) as site:  # carries 0.1 kg of 0.2
                site.share(cube)
                p.resetBaseVelocity(cube, (0.5, 0, 0), physicsClientId=client.id)
                for _ in range(120):
                    site.step()
                speeds = [client.velocity(body)[0][0] for body in (cube, other)]
            self.assertGreater(speeds[1], 0.2)
            self.assertAlmostEqual(sum(speeds), 0.5, delta=1e-6)


class Floor(unittest.TestCase):
    def test_carries_a_press(self):
        """A hand of 5 N presses a cube onto a mirrored floor: it does not sink."""
        for maximal in (False, True):
            with self.subTest(maximal=maximal), Client(gravity=-9.81) as client:
                cube, floor = client.add_cube((0, 0, 0.02), maximal), client.add_floor()
                hand = tandem.SimulatedDevice(start=(0, 0, 0.05), damping=5)
                with tandem.Site(hand, peers=1, client=client.id) as site:
                    site.share(cube, shape=("box", HALF))
                    self.assertEqual(site.obstacles(), [floor])
                    for _ in range(60):
                        site.step()
                    before = client.position(cube)[2]
                    site.push((0, 0, -5))
                    for _ in range(240):
                        site.step()
                    self.assertAlmostEqual(site.force()[2], 5, delta=1e-3)
                    self.assertGreater(client.position(cube)[2], before - 1e-6)
                    self.assertAlmostEqual(client.position(cube)[2], 0.02, delta=2e-4)
                for _ in range(240):  # and PyBullet's own floor carries it afterwards
                    p.stepSimulation(physicsClientId=client.id)
                self.assertAlmostEqual(client.position(cube)[2], 0.02, delta=1e-3)


class TwoUsers(unittest.TestCase):
    def test_meet_over_a_simulated_link(self):
        """Experiment I as in the README: 5 N, 50 ms, 1 s at 60 Hz."""
        with Client(60) as here, Client(60) as there:
            cubes, sites, x = [], [], (-0.03, 0.03)
            for i, client in enumerate((here, there)):
                cubes.append(client.add_cube())
                site = tandem.Site(tandem.SimulatedDevice(start=(x[i], 0, 0)), self_id=i + 1,
                                   client=client.id, guide=(1, 0, 0))
                site.share(cubes[i])
                site.connect(2 - i, site.simulated_link("way", delay=0.05), (x[1 - i], 0, 0))
                sites.append(site)
            sites[0].push((5, 0, 0))
            for _ in range(60):
                for site in sites:
                    site.step()
            at = [client.position(cube)[0] for client, cube in zip((here, there), cubes)]
            force = sites[0].force()[0]
            print(f"Experiment I: cube at {at[0]:.4f} m here, {at[1]:.4f} m there; "
                  f"force on user 1: {force:.3f} N")
            self.assertAlmostEqual(at[0], 0.1266, delta=1e-4)
            self.assertAlmostEqual(at[1], 0.1199, delta=1e-4)
            self.assertAlmostEqual(force, -5.041, delta=1e-3)
            self.assertEqual(sites[0].read().links, ("live",))
            for site in sites:
                site.close()

    def test_may_connect_before_they_share(self):
        """At 240 Hz, where native contact of proxy and cube would take 3 mm away."""
        at = [self.find_where_it_goes(order) for order in ("share first", "connect first")]
        print(f"Experiment I at 240 Hz: cube at {at[0]:.4f} m, {at[1]:.4f} m if connected first")
        self.assertAlmostEqual(at[0], 0.1266, delta=1e-4)
        self.assertAlmostEqual(at[0], at[1], delta=1e-9)

    @staticmethod
    def find_where_it_goes(order):
        with Client(240) as here, Client(240) as there:
            cubes, sites, x = [], [], (-0.03, 0.03)
            for i, client in enumerate((here, there)):
                cubes.append(client.add_cube())
                site = tandem.Site(tandem.SimulatedDevice(start=(x[i], 0, 0)), self_id=i + 1,
                                   client=client.id, guide=(1, 0, 0))
                way = site.simulated_link(order, delay=0.05)
                steps = [lambda: site.share(cubes[i]),
                         lambda: site.connect(2 - i, way, (x[1 - i], 0, 0))]
                for step in steps if order == "share first" else reversed(steps):
                    step()
                sites.append(site)
            sites[0].push((5, 0, 0))
            for _ in range(240):
                for site in sites:
                    site.step()
            for site in sites:
                site.close()
            return here.position(cubes[0])[0]

    def test_carry_packets_by_hand(self):
        with Client(60) as here, Client(60) as there:
            sites, links = [], []
            for i, client in enumerate((here, there)):
                site = tandem.Site(tandem.SimulatedDevice(start=(0.06 * i - 0.03, 0, 0)),
                                   self_id=i + 1, client=client.id)
                site.share(client.add_cube())
                links.append(site.manual_link())
                site.connect(2 - i, links[i], (0.03 - 0.06 * i, 0, 0))
                sites.append(site)
            sites[0].push((2, 0, 0))
            for _ in range(60):
                for site in sites:
                    site.step()
                for i in (0, 1):
                    while (packet := links[i].pop()) is not None:
                        links[1 - i].push(packet)
            x = [site.states()[0].position[0] for site in sites]
            self.assertGreater(x[0], 0.02)
            self.assertAlmostEqual(x[0], x[1], delta=5e-3)
            for site in sites:
                site.close()


class WhatGoesWrong(unittest.TestCase):
    def test_dampings_set_while_attached(self):
        for maximal in (False, True):
            with self.subTest(maximal=maximal), Client() as client:
                cube, floor = client.add_cube(maximal=maximal), client.add_floor()
                before = client.dynamics(cube)
                with tandem.Site(far_hand(), client=client.id) as site:
                    site.share(cube, shape=("box", HALF))
                    site.obstacles()
                    site.step()
                    for body in (cube, floor):
                        p.changeDynamics(body, -1, linearDamping=0.1, angularDamping=0.1,
                                         physicsClientId=client.id)
                    p.resetBaseVelocity(cube, (0, 0, 1), physicsClientId=client.id)
                    for _ in range(4):
                        site.step()
                    said = site.warnings()
                    self.assertFalse(site.read().has_ended, said)
                    self.assertEqual(sorted(said), [
                        f"body {body}: damping was set while attached; it acts again after close"
                        for body in (cube, floor)])
                after = client.dynamics(cube)
                # Mass, friction and inertia; PyBullet reports restitution for multibodies only.
                for place in (0, 1, 2) if maximal else (0, 1, 2, 5):
                    self.assertEqual(after[place], before[place])

    def test_everything_set_in_one_call(self):
        with Client() as client:
            cube, floor = client.add_cube(), client.add_floor()
            with tandem.Site(far_hand(), client=client.id) as site:
                site.share(cube)
                site.obstacles()
                site.step()
                for body, mass in ((cube, 1.0), (floor, 0.0)):
                    p.changeDynamics(body, -1, mass=mass, lateralFriction=0.9, restitution=0.3,
                                     linearDamping=0.1, angularDamping=0.1,
                                     physicsClientId=client.id)
                for _ in range(4):
                    site.step()
                said = "\n".join(site.warnings())
                self.assertFalse(site.read().has_ended, said)
                self.assertIn(f"body {cube}: damping was set", said)
                self.assertAlmostEqual(client.dynamics(cube)[0], 0.5)
            after = client.dynamics(cube)
            self.assertAlmostEqual(after[0], 1.0)
            self.assertEqual((after[1], after[5]), (0.9, 0.3))

    def test_deformable_world(self):
        with Client() as client:
            p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD, physicsClientId=client.id)
            with tandem.Site(far_hand(), client=client.id) as site:
                cube = client.add_cube()
                site.share(cube)
                p.resetBaseVelocity(cube, (0.1, 0, 0), physicsClientId=client.id)
                for _ in range(3):
                    site.step()
                self.assertTrue(site.read().has_ended)
                self.assertIn("without RESET_USE_DEFORMABLE_WORLD", site.warnings()[-1])

    def test_links_of_a_mesh_whose_peer_is_away(self):
        with tempfile.TemporaryDirectory() as folder, Client() as client:
            key = os.path.join(folder, "pair.key")
            tandem.create_key(key, client.id)
            with tandem.Site(far_hand(), client=client.id) as site:
                ways = site.mesh(1, "127.0.0.1:0", [tandem.Peer(2, "127.0.0.1:7999", key)])
                site.connect(2, ways[2])
                site.step()
                self.assertEqual(site.read().links, ("calling",))

    def test_obstacles_of_all_kinds(self):
        """Markers without a collision shape and what is attached are left out; the rest is tried."""
        with Client() as client:
            ball = p.createVisualShape(p.GEOM_SPHERE, radius=0.1, physicsClientId=client.id)
            concave = p.createCollisionShape(
                p.GEOM_MESH, vertices=[(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0.1)],
                indices=[0, 1, 2, 1, 3, 2], flags=p.GEOM_FORCE_CONCAVE_TRIMESH,
                physicsClientId=client.id)
            first = client.add_cube((0, 0, -1), mass=0)
            for maximal in (False, True):
                p.createMultiBody(0, -1, ball, useMaximalCoordinates=maximal,
                                  physicsClientId=client.id)
            p.createMultiBody(0, concave, physicsClientId=client.id)
            last = client.add_cube((0, 0, -2), mass=0)
            with tandem.Site(far_hand(), client=client.id) as site:
                with self.assertWarnsRegex(UserWarning, "mesh.*give shape=hull") as said:
                    self.assertEqual(site.obstacles(), [first, last])
                self.assertEqual(len(said.warnings), 1)
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    self.assertEqual(site.obstacles(), [])

    def test_mesh_that_fails_and_is_tried_again(self):
        with tempfile.TemporaryDirectory() as folder, Client() as client:
            key = os.path.join(folder, "pair.key")
            tandem.create_key(key, client.id)
            with self.assertRaisesRegex(tandem.TandemError, "pair.key"):
                tandem.create_key(key, client.id)
            with tandem.Site(far_hand(), client=client.id) as site:
                for name in (os.path.join(folder, "none.key"), 'a"b'):
                    with self.assertRaises((tandem.TandemError, ValueError)):
                        site.mesh(1, "127.0.0.1:0", [tandem.Peer(2, "127.0.0.1:7999", key),
                                                     tandem.Peer(3, "127.0.0.1:7998", name)])
                ways = site.mesh(1, "127.0.0.1:0", [tandem.Peer(2, "127.0.0.1:7999", key)])
                self.assertEqual(list(ways), [2])

    def test_refused_site_leaves_nothing(self):
        with Client(gravity=math.nan) as client:
            with self.assertRaisesRegex(tandem.TandemError, "gravity"):
                tandem.Site(far_hand(), client=client.id)
            p.setGravity(0, 0, 0, physicsClientId=client.id)
            tandem.Site(far_hand(), client=client.id).close()

    def test_shown_proxy_is_gone_at_the_end(self):
        with Client() as client:
            site = tandem.Site(far_hand(), client=client.id)
            site.connect(2, site.manual_link(), start=(0.2, 0, 0))
            site.step()
            p.resetSimulation(physicsClientId=client.id)
            site.close()
            with self.assertRaisesRegex(tandem.TandemError, "the site is closed"):
                site.warnings()

    def test_proxy_that_cannot_be_shown(self):
        with Client() as client, tandem.Site(far_hand(), client=client.id) as site:
            remote = site.connect(2, site.manual_link(), start=(0.2, 0, 0))
            with self.assertRaisesRegex(tandem.TandemError, "shown already"):
                site._show(remote, (0, 0, 0), (1, 1, 1, 1))
            self.assertEqual(p.getNumBodies(physicsClientId=client.id), 1)

    def test_answers_without_text(self):
        for status, says in ((-1, "closed"), (-6, "memory"), (-7, "-7")):
            with self.assertRaisesRegex(tandem.TandemError, says):
                tandem._check((status, b""))

    def test_unload_and_disconnect_with_a_site_open(self):
        for unload in (True, False):
            with Client() as client:
                site = tandem.Site(far_hand(), client=client.id)
                cube = client.add_cube()
                site.share(cube)
                site.connect(2, site.simulated_link(f"open{unload}"))
                site.step()
                if unload:
                    p.unloadPlugin(site._plugin, physicsClientId=client.id)
                    p.stepSimulation(physicsClientId=client.id)

    def test_bodies_that_cannot_be_shared(self):
        with Client() as client, tandem.Site(far_hand(), client=client.id) as site:
            shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.02, physicsClientId=client.id)
            jointed = p.createMultiBody(
                0.1, shape, linkMasses=[0.1], linkCollisionShapeIndices=[shape],
                linkVisualShapeIndices=[-1], linkPositions=[(0.1, 0, 0)],
                linkOrientations=[(0, 0, 0, 1)], linkInertialFramePositions=[(0, 0, 0)],
                linkInertialFrameOrientations=[(0, 0, 0, 1)], linkParentIndices=[0],
                linkJointTypes=[p.JOINT_REVOLUTE], linkJointAxis=[(0, 0, 1)],
                physicsClientId=client.id)
            for body, says in ((jointed, "links"), (client.add_floor(), "static"), (77, "77"),
                               (client.add_cube(maximal=True), "maximal coordinates")):
                with self.assertRaisesRegex(tandem.TandemError, says):
                    site.share(body)

    def test_second_site_and_unknown_words(self):
        with Client() as client, tandem.Site(far_hand(), client=client.id):
            with self.assertRaisesRegex(tandem.TandemError, "^there is a site already: `close`"):
                tandem.Site(far_hand(), client=client.id)
        with Client() as client:
            with self.assertRaisesRegex(tandem.TandemError, "no word colour"):
                tandem.Site(far_hand(), client=client.id, colour="red")


class RunTime(unittest.TestCase):
    """What a script does to bodies and to the simulation while a site is open."""

    def test_removed_body_takes_only_itself(self):
        with Client(gravity=-9.81) as client, tandem.Site(far_hand(), client=client.id) as site:
            cubes = [client.add_cube((0.2 * i, 0, 0.0205)) for i in range(3)]
            client.add_floor()
            for cube in cubes:
                site.share(cube)
            site.obstacles()
            for _ in range(60):
                site.step()
            p.removeBody(cubes[1], physicsClientId=client.id)
            for _ in range(60):
                site.step()
            self.assertIn("object 1 has no body: share one again with object=1", site.warnings())
            self.assertEqual(site.read().status, ("body_missing",))
            for cube in (cubes[0], cubes[2]):
                self.assertAlmostEqual(client.position(cube)[2], 0.02, delta=1e-3)
            other = client.add_cube((0.2, 0, 0.0205), mass=3.0)
            self.assertEqual(other, cubes[1])  # PyBullet gives the number away again
            self.assertEqual(site.share(other, object=1), 1)
            for _ in range(60):
                site.step()
            self.assertAlmostEqual(client.dynamics(other)[0], 1.5)
            self.assertAlmostEqual(client.position(other)[2], 0.02, delta=1e-3)
            self.assertNotIn("object 1 has no body", "".join(site.warnings()))

    def test_number_of_a_removed_body_is_left_alone(self):
        with Client() as client, tandem.Site(far_hand(), client=client.id) as site:
            cube = client.add_cube()
            site.share(cube)
            site.step()
            p.removeBody(cube, physicsClientId=client.id)
            other = client.add_cube(mass=3.0)
            self.assertEqual(other, cube)
            for _ in range(3):
                site.step()
            self.assertIn("another has its number", site.warnings()[0])
            self.assertEqual(client.dynamics(other)[0], 3.0)

    def test_reset_simulation(self):
        with Client() as client, tandem.Site(far_hand(), client=client.id) as site:
            site.share(client.add_cube())
            client.add_floor()
            site.obstacles()
            site.step()
            p.resetSimulation(physicsClientId=client.id)
            for _ in range(3):
                site.step()
            self.assertIn("object 0 has no body", "".join(site.warnings()))
            cube = client.add_cube()
            site.share(cube, object=0)
            p.resetBaseVelocity(cube, (0.1, 0, 0), physicsClientId=client.id)
            for _ in range(24):
                site.step()
            self.assertFalse(site.read().has_ended)
            self.assertAlmostEqual(site.states()[0].velocity[0], 0.1, delta=1e-6)

    def test_unshared_and_shared_again(self):
        with Client(gravity=-9.81) as client, tandem.Site(far_hand(), client=client.id) as site:
            cube = client.add_cube((0, 0, 0.0205))
            client.add_floor()
            site.share(cube)
            site.obstacles()
            for _ in range(30):
                site.step()
            site.unshare(0)
            self.assertAlmostEqual(client.dynamics(cube)[0], 0.2)
            for _ in range(120):  # PyBullet's own floor carries it
                site.step()
            self.assertGreater(len(p.getContactPoints(cube, physicsClientId=client.id)), 0)
            self.assertAlmostEqual(client.position(cube)[2], 0.02, delta=1e-3)
            site.share(cube, object=0)
            for _ in range(30):
                site.step()
            self.assertAlmostEqual(client.dynamics(cube)[0], 0.1)
            self.assertEqual(site.warnings(), [])

    def test_save_and_restore(self):
        with Client(gravity=-9.81) as client, tandem.Site(far_hand(), client=client.id) as site:
            cube, other = client.add_cube((0, 0, 0.1)), client.add_cube((0.3, 0, 0.1))
            client.add_floor()
            site.share(cube)
            site.obstacles()
            p.resetBaseVelocity(cube, (0.2, 0, 0), (0, 0, 1), physicsClientId=client.id)
            for _ in range(10):
                site.step()
            saved = p.saveState(physicsClientId=client.id)
            before = client.position(cube), client.velocity(cube)
            for _ in range(240):
                site.step()
            at_rest = client.position(cube)
            p.restoreState(saved, physicsClientId=client.id)
            self.assertLess(math.dist(client.position(cube), before[0]), 1e-12)
            site.step()
            self.assertLess(math.dist(client.position(cube), before[0]), 0.02)
            for _ in range(239):
                site.step()
            self.assertEqual(site.read().status, ())
            self.assertLess(math.dist(client.position(cube), at_rest), 2e-3)
            self.assertAlmostEqual(client.position(other)[2], 0.02, delta=2e-3)

    def test_save_and_restore_on_both_sides(self):
        """Both cubes go back to where they were, and stay: no spring throws them."""
        with Client() as here, Client() as there:
            sites, cubes, saved = [], [], []
            for i, client in enumerate((here, there)):
                cubes.append(client.add_cube())
                site = tandem.Site(far_hand(), self_id=i + 1, client=client.id)
                site.share(cubes[i])
                site.connect(2 - i, site.simulated_link("saved", delay=0.05), (10, 0, 0), None)
                sites.append(site)
            def run(steps):
                for _ in range(steps):
                    for site in sites:
                        site.step()
            run(120)
            saved = [p.saveState(physicsClientId=client.id) for client in (here, there)]
            for client, cube in zip((here, there), cubes):
                p.resetBasePositionAndOrientation(cube, (1, 0, 0), (0, 0, 0, 1),
                                                  physicsClientId=client.id)
            run(240)
            for client, state in zip((here, there), saved):
                p.restoreState(state, physicsClientId=client.id)
            worst = 0.0
            for _ in range(480):
                run(1)
                worst = max(worst, *(math.hypot(*client.velocity(cube)[0])
                                     for client, cube in zip((here, there), cubes)))
            print(f"both sides restored, 50 ms, from 1 m away: speed {worst:.1e} m/s")
            self.assertLess(worst, 0.1)
            for client, cube in zip((here, there), cubes):
                self.assertLess(math.hypot(*client.position(cube)), 1e-3)
            for site in sites:
                site.close()

    def test_all_that_change_dynamics_sets(self):
        """Each alone: followed or said, and the cube stays on the floor."""
        wanted = {"mass": 0.5, "lateralFriction": 0.9, "spinningFriction": 0.01,
                  "rollingFriction": 0.01, "restitution": 0.2, "linearDamping": 0.3,
                  "angularDamping": 0.3, "localInertiaDiagonal": (1e-4, 1e-4, 1e-4),
                  "ccdSweptSphereRadius": 0.01, "contactProcessingThreshold": 0.001,
                  "activationState": p.ACTIVATION_STATE_ENABLE_SLEEPING, "collisionMargin": 0.001,
                  "maxJointVelocity": 50, "jointDamping": 0.1}
        pairs = [{key: value} for key, value in wanted.items()]
        pairs.append({"contactStiffness": 1e4, "contactDamping": 10})
        said = {"linearDamping": "damping was set", "angularDamping": "damping was set",
                "contactStiffness": "contact stiffness was set"}
        for change in pairs:
            key = next(iter(change))
            with self.subTest(key), Client(gravity=-9.81) as client, \
                    tandem.Site(far_hand(), client=client.id) as site:
                cube = client.add_cube((0, 0, 0.0205))
                client.add_floor()
                site.share(cube)
                site.obstacles()
                for _ in range(60):
                    site.step()
                p.changeDynamics(cube, -1, physicsClientId=client.id, **change)
                for _ in range(120):
                    site.step()
                self.assertFalse(site.read().has_ended, site.warnings())
                self.assertEqual(site.read().status, ())
                self.assertAlmostEqual(client.position(cube)[2], 0.02, delta=1e-3)
                lines = site.warnings()
                if key in said:
                    self.assertIn(said[key], lines[0])
                else:
                    self.assertEqual(lines, [])

    def test_mass_of_zero(self):
        with Client(gravity=-9.81) as client, tandem.Site(far_hand(), client=client.id) as site:
            cube = client.add_cube((0, 0, 1))
            site.share(cube)
            site.step()
            p.changeDynamics(cube, -1, mass=0, physicsClientId=client.id)
            # PyBullet moves a body of mass 0 on at the velocity that it had.
            p.resetBaseVelocity(cube, (0, 0, 0), physicsClientId=client.id)
            for _ in range(4):
                site.step()
            pinned = client.position(cube)
            for _ in range(60):
                site.step()
            self.assertEqual(client.position(cube), pinned)
            self.assertIn(f"body {cube} was made static", site.warnings())
            p.changeDynamics(cube, -1, mass=0.4, physicsClientId=client.id)
            site.share(cube, object=0)
            for _ in range(24):
                site.step()
            self.assertAlmostEqual(client.velocity(cube)[0][2], -0.981, delta=0.05)

    def test_new_mass_is_felt(self):
        """m/2 of 0.4 kg in place of 0.2 kg: 5 N push half as fast."""
        def speed(mass):
            with Client() as client, \
                    tandem.Site(far_hand(), client=client.id, peers=2) as site:
                cube = client.add_cube()
                site.share(cube)
                site.step()
                if mass:
                    p.changeDynamics(cube, -1, mass=mass, physicsClientId=client.id)
                    for _ in range(3):
                        site.step()
                for _ in range(48):
                    p.applyExternalForce(cube, -1, (0.1, 0, 0), (0, 0, 0), p.LINK_FRAME,
                                         physicsClientId=client.id)
                    site.step()
                return client.velocity(cube)[0][0]
        self.assertAlmostEqual(speed(None), 0.2, delta=1e-3)
        self.assertAlmostEqual(speed(0.4), 0.1, delta=1e-3)

    def test_time_step_and_sub_steps_change(self):
        """A free coupler stays the closed form while the step changes all the time."""
        with Client() as client:
            cube = client.add_cube((0.01, 0, 0))
            with tandem.Site(far_hand(), client=client.id, coordination=(2000, 10),
                             link_loss=False) as site:
                site.share(cube)
                link = site.manual_link()
                site.connect(2, link, start=(-5, 0, 0), show=None)
                link.push(tandem.Packet(2, False, 0, 0.0, (-5, 0, 0), (0, 0, 0), math.nan,
                                        math.nan, [(0, AT_REST)]))
                time, worst = 0.0, 0.0
                for step in range(60):
                    rate, substeps = (240, 60, 120, 1000)[step % 4], (0, 4, 1, 2, 8)[step % 5]
                    p.setTimeStep(1 / rate, physicsClientId=client.id)
                    p.setPhysicsEngineParameter(numSubSteps=substeps, physicsClientId=client.id)
                    site.step()
                    time += 1 / rate
                    worst = max(worst, abs(client.position(cube)[0] - ringing(0.01, time)))
            print(f"free coupler, steps and sub-steps change: {worst:.1e} m")
            self.assertLess(worst, 1e-9)

    def test_robot_pushes(self):
        """A finger on a slider pushes a cube over a floor at 60 Hz: as firmly as without a site."""
        bare, shared = (self.find_overlap(is_shared) for is_shared in (False, True))
        print(f"finger pushes a cube at 60 Hz: overlap {bare[0]:.1e} m bare, {shared[0]:.1e} m "
              f"shared; way {bare[1]:.4f} m and {shared[1]:.4f} m")
        self.assertLess(shared[0], 1.5 * bare[0])
        # The finger's tip goes from -0.05 m at 0.05 m/s for 2 s; the cube's middle is 0.025 m ahead.
        self.assertAlmostEqual(shared[1], 0.075, delta=1e-3)

    @staticmethod
    def find_overlap(is_shared):
        with Client(60, gravity=-9.81) as client:
            shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=(0.01, 0.03, 0.02),
                                           physicsClientId=client.id)
            robot = p.createMultiBody(
                0, -1, basePosition=(-0.06, 0, 0.025), linkMasses=[1],
                linkCollisionShapeIndices=[shape], linkVisualShapeIndices=[-1],
                linkPositions=[(0, 0, 0)], linkOrientations=[(0, 0, 0, 1)],
                linkInertialFramePositions=[(0, 0, 0)],
                linkInertialFrameOrientations=[(0, 0, 0, 1)], linkParentIndices=[0],
                linkJointTypes=[p.JOINT_PRISMATIC], linkJointAxis=[(1, 0, 0)],
                physicsClientId=client.id)
            cube = client.add_cube((0, 0, 0.025), half=(0.025, 0.025, 0.025))
            client.add_floor()
            site = None
            if is_shared:
                site = tandem.Site(far_hand(), peers=1, client=client.id)
                site.share(cube)
                site.obstacles()
            worst = 0.0
            for step in range(120):
                p.setJointMotorControl2(robot, 0, p.VELOCITY_CONTROL, targetVelocity=0.05,
                                        force=100, physicsClientId=client.id)
                p.stepSimulation(physicsClientId=client.id)
                near = p.getClosestPoints(robot, cube, 0.01, physicsClientId=client.id)
                if step >= 60 and near:
                    worst = max(worst, -min(point[8] for point in near))
            way = client.position(cube)[0]
            if site:
                site.close()
            return worst, way

    def test_names(self):
        """Two users who share in different orders pair the same bodies."""
        with Client(60) as here, Client(60) as there:
            sites, bodies = [], []
            for i, client in enumerate((here, there)):
                ball, cube = client.add_cube((0, 0, 0)), client.add_cube((0, 0.5, 0))
                bodies.append((ball, cube))
                site = tandem.Site(far_hand(), self_id=i + 1, client=client.id)
                names = {"ball": ball, "cube": cube} if i else {"cube": cube, "ball": ball}
                self.assertEqual(site.share_all(names), {"ball": 0, "cube": 1})
                site.connect(2 - i, site.simulated_link("named"), (10, 0, 0), None)
                sites.append(site)
            p.resetBaseVelocity(bodies[0][0], (0.2, 0, 0), physicsClientId=here.id)
            for _ in range(60):
                for site in sites:
                    site.step()
            for client, (ball, cube) in zip((here, there), bodies):
                self.assertGreater(client.position(ball)[0], 3e-3)
                self.assertAlmostEqual(client.position(cube)[0], 0, delta=1e-6)
            for site in sites:
                site.close()

    def test_contact_points_of_pybullet(self):
        """Contacts that stay PyBullet's come as from PyBullet."""
        with Client(gravity=-9.81) as client, tandem.Site(far_hand(), client=client.id) as site:
            cube, table = client.add_cube((0, 0, 0.0405)), client.add_cube(mass=0)
            site.share(cube)
            for _ in range(60):
                site.step()
            native = p.getContactPoints(cube, table, physicsClientId=client.id)
            self.assertGreater(len(native), 0)
            self.assertEqual(site.contact_points(cube, table), native)
            self.assertEqual(site.contact_points(table), p.getContactPoints(
                table, physicsClientId=client.id))
            self.assertEqual(site.contact_points(77), ())

    def test_contact_points_with_forces(self):
        """Four points carry a shared cube on an obstacle; PyBullet itself tells none."""
        with Client(gravity=-9.81) as client, \
                tandem.Site(far_hand(), peers=1, client=client.id) as site:
            cube, floor = client.add_cube((0, 0, 0.02)), client.add_floor()
            site.share(cube)
            site.obstacles()
            for _ in range(240):
                site.step()
            self.assertEqual(p.getContactPoints(cube, floor, physicsClientId=client.id), ())
            points = site.contact_points(cube, floor)
            self.assertEqual(len(points), 4)
            self.assertAlmostEqual(sum(point[9] for point in points), 0.2 * 9.81, delta=0.01)
            for point in points:
                self.assertEqual(point[1:3], (cube, floor))
                self.assertAlmostEqual(point[7][2], 1, delta=1e-6)

    def test_filters(self):
        """Pairs, groups and masks of bodies that PyBullet alone knows act on a shared body."""
        for kind in ("none", "pair", "mask"):
            with self.subTest(kind), Client(gravity=-9.81) as client, \
                    tandem.Site(far_hand(), client=client.id) as site:
                cube = client.add_cube((0, 0, 0.1))
                table = client.add_cube((0, 0, 0), half=(0.2, 0.2, 0.02), mass=0)
                site.share(cube)
                if kind == "pair":
                    p.setCollisionFilterPair(cube, table, -1, -1, 0, physicsClientId=client.id)
                if kind == "mask":
                    p.setCollisionFilterGroupMask(cube, -1, 0, 0, physicsClientId=client.id)
                for _ in range(120):
                    site.step()
                if kind == "none":
                    self.assertAlmostEqual(client.position(cube)[2], 0.04, delta=2e-3)
                else:
                    self.assertLess(client.position(cube)[2], -0.5)


class Shapes(unittest.TestCase):
    def test_meshes_may_have_many_points(self):
        with Client() as client, tandem.Site(far_hand(), client=client.id) as site:
            def ball(count):  # points spread evenly over a sphere
                turns = [(math.acos(1 - 2 * (i + 0.5) / count), i * 2.4) for i in range(count)]
                return [(0.05 * math.sin(a) * math.cos(b), 0.05 * math.sin(a) * math.sin(b),
                         0.05 * math.cos(a)) for a, b in turns]
            shape = p.createCollisionShape(p.GEOM_MESH, vertices=ball(600),
                                           physicsClientId=client.id)
            body = p.createMultiBody(0.2, shape, physicsClientId=client.id)
            self.assertEqual(site.share(body), 0)
            other = client.add_cube((1, 0, 0), maximal=True)
            with self.assertRaisesRegex(tandem.TandemError, f"body {other}: .*4097.*4096.*fewer"):
                site.share(other, shape=("hull", ball(4097)))

    def test_all_rest_on_the_floor_as_tall_as_they_are(self):
        for name, kind, size, height in (
                ("sphere", p.GEOM_SPHERE, {"radius": 0.02}, 0.02),
                ("cylinder", p.GEOM_CYLINDER, {"radius": 0.02, "height": 0.06}, 0.03),
                ("box", p.GEOM_BOX, {"halfExtents": (0.03, 0.02, 0.01)}, 0.01),
                ("mesh", p.GEOM_MESH, {"vertices": list(itertools.product((-0.02, 0.02),
                                                                          repeat=3))}, 0.02)):
            with self.subTest(name), Client(gravity=-9.81) as client:
                shape = p.createCollisionShape(kind, physicsClientId=client.id, **size)
                body = p.createMultiBody(0.2, shape, basePosition=(0, 0, height),
                                         physicsClientId=client.id)
                client.add_floor()
                with tandem.Site(far_hand(), peers=1, client=client.id) as site:
                    site.obstacles()
                    site.share(body)
                    for _ in range(240):
                        site.step()
                    self.assertEqual(site.read().status, ())
                    # A hull keeps PyBullet's points, with Bullet's margin around them.
                    self.assertAlmostEqual(client.position(body)[2], height, delta=2.5e-3)


if __name__ == "__main__":
    unittest.main()

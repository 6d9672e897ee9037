#!/usr/bin/env python3
"""Two users push one cube, each in a PyBullet of their own, 50 ms apart.

    PYTHONPATH=folder/of/tandem_pybullet.py push_cube.py [--gui]

Both run in this process, so that it can be tried alone; over a network the way between them is a mesh
instead: docs/pybullet.md. User 1 pushes with 5 N, user 2's hand is empty: Experiment I.
"""

import sys
import time

try:
    import pybullet as p
except ImportError as why:
    print(f"SKIPPED: no PyBullet to run in ({why})")
    sys.exit(77)

import tandem_pybullet as tandem

RATE = 60  # steps of PyBullet per second; the haptic ticks are 1000, inside


class User:
    """One user: a physics client with a cube, a simulated handle, and Tandem between."""

    def __init__(self, number, hand, gui=False):
        self.number, self.hand = number, hand
        self.client = p.connect(p.GUI if gui else p.DIRECT)
        p.setTimeStep(1 / RATE, physicsClientId=self.client)
        shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=(0.02, 0.02, 0.02),
                                       physicsClientId=self.client)
        self.cube = p.createMultiBody(0.2, shape, physicsClientId=self.client)
        self.site = tandem.Site(tandem.SimulatedDevice(start=hand), self_id=number,
                                client=self.client, guide=(1, 0, 0))
        self.site.share(self.cube)

    def meet(self, other):
        way = self.site.simulated_link("between us", delay=0.05)
        self.site.connect(other.number, way, start=other.hand)

    def cube_x(self):
        return p.getBasePositionAndOrientation(self.cube, physicsClientId=self.client)[0][0]


def main(gui):
    here = User(1, (-0.03, 0, 0))
    there = User(2, (0.03, 0, 0), gui)  # a process has one window at most
    if gui:
        p.resetDebugVisualizerCamera(0.4, 0, -30, (0.06, 0, 0), physicsClientId=there.client)
    here.meet(there)
    there.meet(here)
    here.site.push((5, 0, 0))
    for _ in range(RATE):
        here.site.step()
        there.site.step()
        if gui:
            time.sleep(1 / RATE)
    print(f"cube at {here.cube_x():.4f} m here, {there.cube_x():.4f} m there; "
          f"force on user 1: {here.site.force()[0]:.3f} N")
    for user in (here, there):
        for line in user.site.warnings():
            print(f"user {user.number}: {line}")
        user.site.close()
        p.disconnect(user.client)


if __name__ == "__main__":
    main("--gui" in sys.argv[1:])

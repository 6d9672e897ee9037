#!/usr/bin/env python3
"""What the plugin adds to p.stepSimulation(), in microseconds per host step.

    PYTHONPATH=folder/of/tandem_pybullet.py pybullet_overhead.py [--blocks N]

Two physics clients of the same scene, one without and one with the plugin, take turns block by block,
so that both see the same machine; medians over the blocks, and of the differences of neighbours.
"""

import argparse
import statistics
import sys
import time

try:
    import pybullet as p
except ImportError as why:
    print(f"SKIPPED: no PyBullet to measure with ({why})")
    sys.exit(77)

import tandem_pybullet as tandem

BLOCK = 2e-3  # about [s]


def make_client(bodies, substeps=0):
    client = p.connect(p.DIRECT)
    p.setPhysicsEngineParameter(numSubSteps=substeps, physicsClientId=client)
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=(0.02, 0.02, 0.02),
                                   physicsClientId=client)
    for i in range(bodies):
        p.createMultiBody(0.2, shape, basePosition=(i, 0, 0), physicsClientId=client)
    return client


def time_steps(client, count):
    step = p.stepSimulation
    start = time.perf_counter()
    for _ in range(count):
        step(client)
    return (time.perf_counter() - start) / count * 1e6


def compare(name, bare, other, blocks):
    """One line of the table; `other`: a client, or a site."""
    site = other if isinstance(other, tandem.Site) else None
    client = site.client if site else other
    count = max(10, int(BLOCK * 1e6 / time_steps(client, 100)))
    without, with_plugin = [], []
    for block in range(blocks):
        turns = ((bare, without), (client, with_plugin))
        for turn, times in turns if block % 2 == 0 else reversed(turns):
            times.append(time_steps(turn, count))
    added = statistics.median(b - a for a, b in zip(without, with_plugin))
    print(f"{name:44} {statistics.median(without):8.2f} {statistics.median(with_plugin):8.2f} "
          f"{added:+8.3f}")
    if site:
        site.close()
    p.disconnect(bare)
    p.disconnect(client)


def make_site(bodies, shared, substeps=0, moving=False):
    """A site in a client of its own, that shares the first bodies."""
    client = make_client(bodies, substeps)
    site = tandem.Site(tandem.Device(start=(0, 10, 0)), client=client)
    for body in range(shared):
        site.share(body)
        if moving:
            p.resetBaseVelocity(body, (0, 0.1, 0), physicsClientId=client)
    return site


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--blocks", type=int, default=400)
    blocks = parser.parse_args().blocks
    print(f"{'us per step, medians of ' + str(blocks) + ' blocks':44} {'without':>8} {'with':>8} "
          f"{'added':>8}")
    for bodies in (1, 100):
        loaded = make_client(bodies)
        p.loadPlugin(tandem.find_plugin(), "_tandem", physicsClientId=loaded)
        compare(f"{bodies} bodies, nothing registered", make_client(bodies), loaded, blocks)
    for bodies in (1, 100):
        compare(f"{bodies} bodies, two clients without the plugin", make_client(bodies),
                make_client(bodies), blocks)
    compare("1 body, a site with nothing shared", make_client(1), make_site(1, 0), blocks)
    compare("1 body, shared, at rest", make_client(1), make_site(1, 1), blocks)
    compare("1 body, shared, moving", make_client(1), make_site(1, 1, moving=True), blocks)
    compare("1 body, shared, moving, 4 sub-steps", make_client(1, 4),
            make_site(1, 1, 4, moving=True), blocks)
    compare("8 bodies, all shared, moving", make_client(8), make_site(8, 8, moving=True), blocks)


if __name__ == "__main__":
    main()

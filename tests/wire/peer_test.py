#!/usr/bin/env python3
"""`tandem peer` and peer.py, which was written from the standard alone, in one session.

Usage: peer_test.py TANDEM SCENARIO
"""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PEER = Path(__file__).with_name("peer.py")
TANDEM, SCENARIO = sys.argv.pop(1), sys.argv.pop(1)
PORT = 17950
# A loopback address that no other process uses: tests may run twice at a time.
HOST = "127.%d.%d.%d" % (1 + (os.getpid() >> 16), os.getpid() >> 8 & 255, os.getpid() & 255)


class PeerTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.key = os.path.join(self.folder.name, "k.psk")
        subprocess.run([TANDEM, "key", "new", self.key], check=True, capture_output=True)

    def tearDown(self):
        self.folder.cleanup()

    def together(self, site, *more):
        """peer.py as this site, tandem as the other one: both status and output."""
        global PORT
        PORT += 2
        ours = subprocess.Popen([sys.executable, "-B", PEER, "--site", str(site), "--bind", str(PORT), "--peer",
                                 str(PORT + 1), "--key", self.key, "--host", HOST, *more], text=True, stdout=subprocess.PIPE)
        theirs = subprocess.run([TANDEM, "peer", "--scenario", SCENARIO, "--set", "experiment.duration=0.5", "--site",
                                 str(3 - site), "--bind", f"{HOST}:{PORT + 1}", "--peer", f"{HOST}:{PORT}",
                                 "--key", self.key, "--wait", "30"], text=True, capture_output=True, timeout=180)
        try:
            output, _ = ours.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            ours.kill()
            raise
        return ours.returncode, output.split(), theirs

    def test_either_site_is_written_from_the_standard(self):
        for site in (1, 2):
            status, words, theirs = self.together(site, "--run", "20")
            self.assertEqual((status, theirs.returncode), (0, 0), theirs.stderr)
            self.assertNotEqual(words[1], "none")
            self.assertGreater(int(words[3]), 10, "states of the run")
            self.assertIn("live", theirs.stdout)

    def test_a_countdown_that_is_too_long_is_refused(self):
        _, _, theirs = self.together(1, "--countdown", "976")
        self.assertEqual(theirs.returncode, 1)
        self.assertIn("counts down 976 s to the start, at most 30 s are allowed", theirs.stderr)

    def test_a_peer_that_leaves_ends_the_countdown(self):
        _, _, theirs = self.together(1, "--countdown", "25", "--leave")
        self.assertEqual(theirs.returncode, 1)
        self.assertIn("site 1 left before the start", theirs.stderr)


if __name__ == "__main__":
    unittest.main()

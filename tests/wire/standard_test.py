#!/usr/bin/env python3
"""What standard.py must see, and that the sealing it checks a golden file with is RFC 8439's."""

import contextlib
import io
import shutil
import struct
import tempfile
import unittest
from pathlib import Path

import seal
import standard
from datagrams import Refused, read_datagram, records_of

GOLDEN = Path(__file__).resolve().parent / "golden"
RECORDING = GOLDEN / "recording.bin"


def run(*arguments):
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()):
        return standard.main([str(argument) for argument in arguments]), out.getvalue()


class StandardTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.golden = Path(self.folder.name, "golden")
        shutil.copytree(GOLDEN, self.golden)

    def tearDown(self):
        self.folder.cleanup()

    def test_golden_files_are_as_the_index_says(self):
        self.assertEqual(run("check", self.golden)[0], 0)

    def test_sees_a_changed_byte_in_any_golden_file(self):
        for file in sorted(self.golden.glob("*.bin")):
            content = bytearray(file.read_bytes())
            content[-1] ^= 1
            file.write_bytes(content)
            self.assertEqual(run("check", self.golden)[0], 1, file.name)
            content[-1] ^= 1
            file.write_bytes(content)

    def test_writes_the_golden_files_it_checks(self):
        for file in self.golden.glob("*.bin"):
            file.unlink()
        self.assertEqual(run("write", self.golden)[0], 0)
        for file in GOLDEN.glob("*.bin"):
            self.assertEqual((self.golden / file.name).read_bytes(), file.read_bytes(), file.name)

    def test_reads_a_recorded_run(self):
        status, text = run("read", RECORDING)
        self.assertEqual((status, len(text.splitlines())), (0, 19))
        self.assertTrue(text.startswith("1 HELLO version=3 session=0 sender=2 "))

    def test_a_recorded_run_ends_at_a_break(self):
        content = RECORDING.read_bytes()
        bad = Path(self.folder.name, "bad.bin")
        for spoilt in (content[:-1], content + b"\1", content + struct.pack("<I", 0),
                       content + struct.pack("<I", 21) + content[4:25]):
            bad.write_bytes(spoilt)
            status, text = run("read", bad)
            self.assertEqual(status, 1)
            self.assertIn("breaks the standard: ", text)

    def test_every_truncation_is_refused(self):
        for datagram in records_of(RECORDING.read_bytes()):
            for size in range(len(datagram)):
                with self.assertRaises(Refused):
                    read_datagram(datagram[:size])

    def test_wrong_calls_are_told(self):
        self.assertEqual(run()[0], 2)
        self.assertEqual(run("look", RECORDING)[0], 2)

    def test_sealing_is_that_of_rfc_8439(self):
        """Section 2.8.2 of the RFC."""
        key, nonce = bytes(range(0x80, 0xa0)), bytes.fromhex("070000004041424344454647")
        text = (b"Ladies and Gentlemen of the class of '99: If I could offer you only one tip for the "
                b"future, sunscreen would be it.")
        sealed = seal.seal(key, nonce, text, bytes.fromhex("50515253c0c1c2c3c4c5c6c7"))
        self.assertEqual(sealed[:16].hex(), "d31a8d34648e60db7b86afbc53ef7ec2")
        self.assertEqual(sealed[-16:].hex(), "1ae10b594f09e26a7e902ecbd0600691")
        self.assertIsNone(seal.open_sealed(key, nonce, sealed, b""))


if __name__ == "__main__":
    unittest.main()

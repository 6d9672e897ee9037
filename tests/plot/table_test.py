"""CSV tables that `tandem plot` reads: columns by name, or a message that names what is broken."""

import random
import tempfile
import unittest

from support import message_of
from table import Table, read_table


def error_of(text):
    return message_of(lambda: Table(text, "a.csv"))


class TableTest(unittest.TestCase):
    def test_finds_columns_by_name_in_any_order(self):
        table = Table("force_x, t ,contact\r\n1.5,0,1\r\n-2e-3,0.001,0\r\n", "a.csv")
        self.assertEqual(len(table), 2)
        self.assertEqual(list(table["t"]), [0.0, 0.001])
        self.assertEqual(list(table["force_x"]), [1.5, -2e-3])
        self.assertIn("contact", table)
        self.assertNotIn("object_x", table)

    def test_reads_last_line_without_newline(self):
        self.assertEqual(list(Table("t,proxy_x\n0,1\n\n 2 , 3", "a.csv")["proxy_x"]), [1.0, 3.0])

    def test_names_the_line_of_a_value_that_is_not_finite(self):
        for cell in ("nan", "-nan", "NaN", "inf", "-Infinity", "1e999"):
            with self.subTest(cell):
                self.assertEqual(error_of(f"t,x\n0,1\n\n1,{cell}\n2,3\n"),
                                 f'a.csv: line 4, column "x": "{cell}" is not a finite number')

    def test_reads_numbers_whose_sum_is_too_large(self):
        self.assertEqual(list(Table("t,x\n1e308,1e308\n", "a.csv")["x"]), [1e308])

    def test_names_file_line_and_column_of_what_is_broken(self):
        for text, message in {
                "t,x\n0,1\n1,one\n": 'line 3, column "x": "one" is not a number',
                "t,x\n0,\n": 'line 2, column "x": "" is not a number',
                "t,x\n0,1_000\n": 'line 2, column "x": "1_000" is not a number',
                "t,x\n0,1\n1\n": "line 3: 1 values, but the header names 2 columns",
                "t,x\n0,1,2\n": "line 2: 3 values, but the header names 2 columns",
                "t,x,t\n": 'line 1: column "t" appears twice',
                "t,,x\n": "line 1: a column has no name",
                "": "line 1: a column has no name",
                "\0\n1\n2,3\n": "line 3: 2 values, but the header names 1 columns",
                "t,x\n": "no rows below the header"}.items():
            with self.subTest(text):
                self.assertEqual(error_of(text), f"a.csv: {message}")
        self.assertEqual(message_of(lambda: Table("t\n0\n", "a.csv")["force_x"]),
                         'a.csv: column "force_x" is missing')

    def test_gives_back_random_numbers_exactly(self):
        """Seventeen digits are enough to give back every double."""
        numbers = random.Random(20240917)
        a = [(numbers.random() - 0.5) * 10 ** (40 * numbers.random() - 20) for _ in range(500)]
        table = Table("a,b\n" + "".join(f"{x:.17g},{-x:.17g}\n" for x in a), "a.csv")
        self.assertEqual(list(table["a"]), a)
        self.assertEqual(list(table["b"]), [-x for x in a])

    def test_random_text_is_a_table_or_a_message(self):
        numbers = random.Random(7)
        for _ in range(3000):
            text = "".join(numbers.choices("t,x\n\r 01.-eE_naif+\0é", k=numbers.randrange(40)))
            message = message_of(lambda: self.assertGreater(len(Table(text, "a.csv")), 0))
            self.assertTrue(message == "" or message.startswith("a.csv: "), message)

    def test_refuses_a_folder_and_a_missing_file(self):
        folder = tempfile.gettempdir()
        self.assertIn("cannot be read", message_of(lambda: read_table(folder)))
        self.assertIn("no-such.csv: cannot", message_of(lambda: read_table("no-such.csv")))

    def test_measures_vectors(self):
        table = Table("f_x,f_y,f_z\n3,0,4\n0,0,-1\n", "a.csv")
        self.assertEqual(list(table.norm("f")), [5.0, 1.0])


if __name__ == "__main__":
    unittest.main()

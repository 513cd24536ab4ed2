"""Constants of a library that is newer than the package, and sizes of grids that no library accepts."""

import unittest

import numpy as np

import contact_normal as cn
from contact_normal._bill import BillRow
from contact_normal._library import initialised
from contact_normal._prices import Price
from contact_normal._quantities import Quantity


class Names(unittest.TestCase):
    def test_numbers_without_a_name_are_told(self):
        row = initialised("quantity_row")
        row.lack = 9
        self.assertEqual(Quantity.of(row).lack, "number 9")
        row.quantity, row.lack = 99, -1
        self.assertEqual((Quantity.of(row).name, Quantity.of(row).lack), ("number 99", "number -1"))
        price = initialised("price")
        price.obstacle = 7
        self.assertEqual(Price.of(price).obstacle, "number 7")
        effects = initialised("effects_row")
        effects.omitted, effects.also_omitted, effects.verdict, effects.lack, effects.quantity = 1, 99, 3, 9, 99
        bill = BillRow.of(effects)
        self.assertEqual((bill.omitted[1], bill.verdict, bill.lack, bill.quantity), ("number 99", "number 3", "number 9", "number 99"))
        self.assertNotIn("number", bill.omitted[0])


class Grids(unittest.TestCase):
    def test_no_room_is_made_for_grids_that_are_refused(self):
        for coarser in (13, 10**7, 2**31 - 1, -1):
            with self.assertRaisesRegex(cn.ContactNormalError, f"coarser is {coarser}; it must lie in 0..12"):
                cn.quantities(np.zeros((4, 4)), 1.0, 1.0, names=["force"], coarser=coarser, approach=0.1, e_star=1.0)


if __name__ == "__main__":
    unittest.main()

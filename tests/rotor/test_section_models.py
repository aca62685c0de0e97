"""What a section model can do is asked once for each class."""

import numpy as np

from proprotor.rotor.airfoil import Airfoil, has_points


class Counting:
    """A section model with points that counts how often its real part is made."""

    made = 0
    is_complex = False

    @property
    def real(self):
        Counting.made += 1
        return self

    def take(self, rows, stations):
        return self


class Plain:
    """A section model whose numbers are the same at all points."""

    def coefficients(self, alpha, mach):
        return alpha, mach


def test_the_answer_is_that_of_the_class_and_makes_no_real_part_again():
    assert has_points(Airfoil(lift_slope=np.array([5.7, 5.8]))) and not has_points(Plain())
    assert all(has_points(Counting()) for _ in range(5)) and Counting.made <= 1

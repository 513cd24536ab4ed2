"""The paper's problem: an ellipse of steel on steel, pressed by 0.1091 mm. Prints the force."""

import numpy as np

import contact_normal

x, y = (np.arange(128) + 0.5) * 20 / 128 - 10, (np.arange(128) + 0.5) * 12 / 128 - 6
h = 0.0016681 * x[None, :] ** 2 + 0.0030671 * y[:, None] ** 2
steel = {"shear_modulus": 82000.0, "poisson_ratio": 0.28}
result = contact_normal.solve(h, 20 / 128, 12 / 128, approach=0.1091, **steel)
assert result.status == contact_normal.OK, result.message
print(f"force {result.force:.0f} N")

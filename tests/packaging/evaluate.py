"""The Python package, as Debian installs it: a material in both precisions, its samples, its name for pip.

SPDX-License-Identifier: MIT
"""
import importlib.metadata

import facet
import numpy as np

m = facet.material("ggx alpha=.3 ks=.9,.7,.3")
for dtype in (np.float32, np.float64):
    wi, wo = np.array([0, 0.6, 0.8], dtype), np.array([0, -0.6, 0.8], dtype)
    f, p = m.eval_pdf(wi, wo)
    assert f.dtype == dtype
    # README.md has what the program says of it.
    np.testing.assert_allclose(f, [0.97049129, 0.754903257, 0.323727131], rtol=1e-6)
    np.testing.assert_allclose(p, 1.09159756, rtol=1e-6)
    drawn = m.sample(wo, np.full((1000, 3), 0.5, dtype))
    np.testing.assert_allclose(drawn.pdf, m.pdf(drawn.wi, wo), rtol=8 * np.finfo(dtype).eps)  # wi is rounded
assert importlib.metadata.version("facet-brdf") == facet.__version__
print(f"python3-facet {facet.__version__}: {m.spec}, NumPy {np.__version__}, {len(facet.models())} models")

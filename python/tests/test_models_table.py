"""Constructors, parameters and errors follow the library's table.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import copy
import inspect
import json
import pickle
import subprocess

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import facet

PARAMETERS = [(m, p) for m in facet.models().values() for p in m.parameters.values()]
IDS = [f"{m.name}.{p.name}" for m, p in PARAMETERS]


def with_partner(model: facet.Model, name: str, value: object) -> dict[str, object]:
    """Parameters that mean nothing alone, with their partner."""
    values = {name: value}
    if name in ("eta", "k") and "eta" in model.parameters and "k" in model.parameters:
        values["k" if name == "eta" else "eta"] = model.parameters["k" if name == "eta" else "eta"].default
    return values


def test_the_program_lists_the_same_table(program: str) -> None:
    listed = json.loads(subprocess.run([program, "materials", "--json"], capture_output=True, check=True).stdout)
    models = listed["models"] if isinstance(listed, dict) else listed
    assert [m["name"] for m in models] == list(facet.models())
    for m in models:
        mine = facet.models()[m["name"]]
        assert m["summary"] == mine.summary
        assert [p["name"] for p in m["parameters"]] == list(mine.parameters)


@pytest.mark.parametrize("model, p", PARAMETERS, ids=IDS)
def test_ranges_are_what_is_accepted(model: facet.Model, p: facet.Parameter) -> None:
    if p.kind == "choice":
        for choice in p.choices:
            assert model(**with_partner(model, p.name, choice))[p.name] == choice
        with pytest.raises(ValueError, match=rf"{p.name}: 'neither' is not a choice; give one of "):
            model(**with_partner(model, p.name, "neither"))
        for index in (0, 1, 1.0, None, True):
            with pytest.raises(TypeError, match=rf"^{p.name}: .* is not a text; give one of "):
                model(**with_partner(model, p.name, index))
        return
    for end in (p.low, p.high):
        got = model(**with_partner(model, p.name, end))[p.name]
        assert got == ((end,) * 3 if p.kind == "colour" else end)
    for beyond in (np.nextafter(p.low, -np.inf), np.nextafter(p.high, np.inf), np.nan, np.inf, -np.inf):
        with pytest.raises(ValueError, match=rf"^{p.name}: .* is out of range; give .* in \["):
            model(**with_partner(model, p.name, beyond))
    for nonsense in (None, "red", [0.1, 0.2, 0.3, 0.4] if p.kind == "colour" else [0.1, 0.2], object(), 1j):
        with pytest.raises((TypeError, ValueError), match=p.name):
            model(**with_partner(model, p.name, nonsense))


@pytest.mark.parametrize("model, p", PARAMETERS, ids=IDS)
def test_defaults_are_the_materials_own(model: facet.Model, p: facet.Parameter) -> None:
    assert model()[p.name] == p.default
    assert p.unit and p.description and p.range and p.default_text
    assert inspect.signature(model).parameters[p.name].default == p.default
    assert p.name in (model.__doc__ or "")


def test_errors_are_of_the_right_kind() -> None:
    with pytest.raises(ValueError, match="^no model is called 'gxx'; give one of lambert"):
        facet.material("gxx")
    with pytest.raises(ValueError, match=r"^alpha: 7 is out of range; give a number in \[0.0001, 4\]$"):
        facet.material("ggx alpha=7")
    with pytest.raises(TypeError, match=r"^ggx\(\) has no parameter 'roughness'; it has alpha"):
        facet.ggx(roughness=0.3)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match=r"^ggx\(\) takes its parameters by name"):
        facet.ggx(0.3)  # type: ignore[misc]
    for nothing in (3, None, b"ggx"):
        with pytest.raises(TypeError, match="^spec: .* is not a text"):
            facet.material(nothing)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="^ior: 'ks' is given as well; give one of the two$"):
        facet.ggx(ks=0.5, ior=1.5)
    with pytest.raises(ValueError, match="zero bytes"):
        facet.material("ggx\0")
    with pytest.raises(KeyError):
        facet.ggx()["roughness"]


numbers = st.floats(0.0001, 1, allow_subnormal=False)


@given(numbers, numbers, st.tuples(numbers, numbers, numbers), st.sampled_from(["correlated", "separable"]))
def test_a_specification_is_the_material(a: float, b: float, ks: tuple[float, float, float], g2: str) -> None:
    m = facet.ggx(alpha_x=a, alpha_y=b, ks=ks, g2=g2)  # type: ignore[arg-type]
    again = facet.material(m.spec)
    assert again.values == m.values and again == m and hash(again) == hash(m)
    assert m["alpha_x"] == a and m["ks"] == ks
    for other in (pickle.loads(pickle.dumps(m)), copy.deepcopy(m)):
        assert other == m and other.values == m.values
    assert m.given == {"alpha_x": a, "alpha_y": b, "ks": ks, "g2": g2}
    wi = facet.direction(0.4)
    np.testing.assert_array_equal(again.eval(wi, wi), m.eval(wi, wi))
    assert m.replace(g2="separable")["alpha_y"] == b


def test_a_colour_may_be_an_array_or_a_grey() -> None:
    assert facet.lambert(kd=np.array([0.1, 0.2, 0.3], np.float64))["kd"] == (0.1, 0.2, 0.3)
    assert facet.lambert(kd=0.5) == facet.lambert(kd=(0.5, 0.5, 0.5)) == facet.material("lambert kd=.5")
    assert facet.lambert(kd=0.5) != facet.lambert(kd=0.25) and facet.lambert() != "lambert"


def test_names_are_there() -> None:
    assert set(facet.models()) <= set(dir(facet)) and set(facet.models()) <= set(facet.__all__)
    assert repr(facet.gtr) == "facet.gtr" and pickle.loads(pickle.dumps(facet.gtr)) is facet.gtr
    assert repr(facet.ggx(alpha=0.25)) == "facet.material('ggx alpha=0.25')"
    assert "<td>" in facet.gtr._repr_html_()
    assert facet.__version__.count(".") == 2 and "base" in facet.instruction_sets()

#!/usr/bin/env python3
"""Writes the made inputs of the fuzzing programs: tests/fuzz/make_corpus.py [--check]

They are small and valid, or nearly so; what fuzzing found lies beside them.  --check: nothing is written, and the
status is 1 if a file differs from what would be.

SPDX-License-Identifier: MIT
"""
import os
import struct
import sys

CORPUS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "corpus")

# As in cli/command_list.c: the first byte of an input of `arguments`.
COMMANDS = "render merge compare eval sample terms albedo plot verify materials scenes info".split()

ARGUMENTS = {
    "render": ["scene.glb", "-o", "a.exr", "-oa.png", "--spp", "16", "--size=64x32", "--crop", "1,2,3,4", "--env", "1,1,.5",
               "--env-scale", "2", "--depth", "4", "-t", "2", "--seed", "7", "--time", "1", "--noise", ".01",
               "--material", "ball=ggx alpha=.2", "--strategy", "mis", "--sampler", "random", "--gradients",
               "off", "--isa", "avx2", "--max-memory", "512M", "--allow-outside", "--exposure", "-1", "--view", "agx", "--half", "--quiet",
               "--events", "-", "--json", "--camera", "far"],
    "merge": ["a.ckpt", "b.ckpt", "-o", "a.png", "--exposure=2", "--"],
    "compare": ["a.exr", "b.exr", "--metric", "flip", "--max", "0.1", "--diff", "d.png"],
    "eval": ["ggx alpha=.3", "--wi", "0,0.6,0.8", "--wo", "0,-0.6,0.8", "--double"],
    "sample": ["ggx", "--wo", "0,0,1", "-n", "5", "--seed", "9007199254740992"],
    "terms": ["ggx", "--csv", "-"],
    "albedo": ["ggx", "--cos", "1,0.5,0.1"],
    "plot": ["ggx", "--of", "D", "-o", "a.svg"],
    "verify": ["ggx", "--json"],
    "materials": ["--json"],
    "scenes": ["--help"],
    "info": ["a.glb", "--json", "--max-memory=1T"],
}

MATERIALS = {
    "lambert": "lambert kd=.8,.7,.6",
    "phong": "phong exponent=50 ks=.5",
    "beckmann": "beckmann alpha=.3 ior=1.5 masking=published",
    "ggx": "ggx alpha_x=.1 alpha_y=.4 metal=Au sampling=ndf",
    "gtr": "gtr alpha=.1 gamma=1.5 f82=.9,.8,.7 ks=.9 energy=multi",
    "gtr20": "gtr alpha=1e-4 gamma=20 g2=separable",
    "glass": "glass ior=1.5 alpha=.2 ndf=beckmann",
    "ward": "ward variant=duer alpha_x=.1 alpha_y=.3 ks=.5,.5,.5 kd=.2",
    "cs500": "cs500 alpha=.2 kd=.5 ks=.04",
    "disney": "disney base_color=.8,.2,.1 metallic=0 roughness=.4 anisotropic=.5 sheen=1 clearcoat=1",
    "vray": "vray sharpness=.8 gamma=1.2",
    "metallic_roughness": "metallic_roughness base_color=1 metallic=1 roughness=0",
}

JSON = {
    "ggx": '{"model": "ggx", "alpha": 0.2, "ks": [0.9, 0.7, 0.3], "g2": "separable"}',
    "gtr": '{"model": "gtr", "alpha": 1e-4, "gamma": 0.5, "metal": "Cu", "energy": "multi"}',
    "disney": '{"model": "disney", "base_color": [0.8, 0.2, 0.1], "roughness": 0, "extras": {"a": [1, null, true]}}',
    "glass": '{"model": "glass", "ior": 1.33, "alpha": 0.1, "ndf": "ggx"}',
    "wrong": '{"model": "ggx", "alpha": "x", "nothing": [[[]]]}',
}

CSV = {
    "rows": b"\x05model,wi_x,wi_y,wi_z,pdf\n1,0,0.6,0.8,1e-3\n# a comment\n\n2, 1 ,0,0,-0\r\n",
    "words": b"\x81model,wi_x,other,wi_y,wi_z,pdf\nggx alpha=.3,0,x,0,1,2\n",
    "mark": b"\x00\xef\xbb\xbfpdf\n0x1p-3\nnan\n",
    "short": b"\x05model,wi_x,wi_y,wi_z,pdf\n1,2\n",
    "twice": b"\x02wi_x,wi_x\n1,2\n",
}

URIS = ["a.bin", "./sub/b.bin", "sub/../a.bin", "../out.bin", "%2e%2e/out.bin", "link.bin", "inner.bin", "up/out.bin",
        "up/in/a.bin", "file:a.bin", "file:///etc/passwd", "/etc/passwd", "%2Fetc/passwd", "sub/../../out.bin",
        "file://localhost/dev/null", "http://localhost/a.bin", "data:;base64,AAAA", "sub%2f..%2f..%2fout.bin", "", "."]

IDENTITY = [("facet:version", "0.1.0"), ("facet:command", "facet render --shard 1/2"), ("facet:scene_hash", "0" * 16),
            ("facet:seed", "0"), ("facet:samples", "2"), ("facet:isa", "avx2"), ("facet:strategy", "mis"),
            ("facet:sampler", "sobol"), ("facet:gradients", "auto"), ("facet:depth", "8"),
            ("facet:features", "not kept"), ("facet:camera", "front"), ("facet:size", "2x2"), ("facet:crop", "0,0,2,2"),
            ("facet:world_to_camera", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"),
            ("facet:world_to_ndc", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1")]


def checkpoint(shard, shards, width=2, height=2, texts=IDENTITY, samples=1, features=False):
    """An input of `checkpoint`: the file without its checksums, behind a 1."""
    texts = b"".join(f"{key}\0{value}\0".encode() for key, value in texts + [("facet:shard", f"{shard}/{shards}")])
    head = b"facetckp" + struct.pack("<6I", 2, len(texts), width, height, features, samples)
    head += struct.pack("<5Q3d", 4, 9, 4, 0, 0, 0.5, 0.25, 0.5) + bytes(12*8)
    pixel = struct.pack("<8QI", 1 << 51, 0, 1 << 50, 0, 1 << 49, 0, 1 << 40, 0, samples)
    if features:
        pixel += struct.pack("<6q2QI", 1 << 40, 1 << 39, 1 << 38, 0, 0, 1 << 40, 1 << 52, 0, samples)
    return b"\1" + head + texts + pixel*(width*height)


def merge(*inputs):
    return struct.pack("<H", len(inputs[0])) + b"".join(inputs)


def merl(*changes):
    """Two directions, then changes of eight bytes each."""
    directions = bytes([0, 32, 0, 16, 0, 0, 0, 48, 0, 80, 0, 0])
    return b"\1" + directions + b"".join(struct.pack("<I", place) + value for place, value in changes)


def files():
    """(path, content) of each."""
    for name, words in ARGUMENTS.items():
        yield f"arguments/{name}", bytes([COMMANDS.index(name)]) + "\n".join(words).encode()
    yield "arguments/shard", b"\0" + b"\n".join([b"--shard", b"3/16", b"--checkpoint", b"a.ckpt", b"--resume", b"a.ckpt"])
    for name, text in MATERIALS.items():
        yield f"material/{name}", text.encode()
    for name, text in JSON.items():
        yield f"material_json/{name}.json", text.encode()
    for name, text in CSV.items():
        yield f"csv/{name}.csv", text
    for i, uri in enumerate(URIS):
        yield f"uri/{i:02}", uri.encode()
    whole = checkpoint(1, 1, texts=IDENTITY, samples=2)
    yield "checkpoint/whole", whole
    yield "checkpoint/none", checkpoint(1, 1, texts=[], width=1, height=1)
    yield "checkpoint/features", checkpoint(1, 1, texts=IDENTITY, samples=2, features=True)
    yield "checkpoint/raw", b"\0" + whole[1:]
    yield "merge/shards", merge(checkpoint(1, 2), checkpoint(2, 2))
    yield "merge/alone", merge(whole)
    yield "merge/same", merge(checkpoint(1, 2), checkpoint(1, 2))
    number, infinite = struct.pack("<d", 1500.0), struct.pack("<d", float("inf"))
    yield "merl/number", merl((12, number), (12 + 8*90*180*45, number), (34992012 - 8, number))
    yield "merl/infinite", merl((1212, infinite))
    yield "merl/sizes", merl((0, struct.pack("<II", 90, 91)))
    yield "merl/short", b"\0" + struct.pack("<3I", 90, 90, 180) + number
    yield "merl/cut", b"\3" + merl()[1:]


def main():
    is_check, wrong = sys.argv[1:] == ["--check"], []
    for path, content in files():
        path = os.path.join(CORPUS, path)
        if is_check:
            if not os.path.exists(path) or open(path, "rb").read() != content:
                wrong.append(path)
            continue
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as stream:
            stream.write(content)
    for path in wrong:
        print(f"{path}: differs from what tests/fuzz/make_corpus.py writes")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()

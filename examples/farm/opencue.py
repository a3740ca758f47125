#!/usr/bin/env python3
"""Renders a scene as an OpenCue job of N frames, each a shard, and a layer that merges them.

    examples/farm/opencue.py N SCENE OUT.exr [OPTION OF facet render]...

OUT.exr.K.ckpt is shard K; a frame that is retried goes on where it was.  Needs pyoutline, and SHOW and SHOT as the
farm names them in the environment.

SPDX-License-Identifier: MIT
"""
import getpass
import os
import sys

import outline
import outline.cuerun
import outline.modules.shell

FRAME = "#IFRAME#"  # replaced by OpenCue


def build(n_shards, scene, out, options):
    job = outline.Outline("facet-" + os.path.splitext(os.path.basename(scene))[0],
                          show=os.environ.get("SHOW", "testing"), shot=os.environ.get("SHOT", "facet"),
                          user=getpass.getuser())
    checkpoint = f"{out}.{FRAME}.ckpt"
    render = outline.modules.shell.Shell(
        "render", range=f"1-{n_shards}", threadable=True,
        command=["facet", "render", scene, "--shard", f"{FRAME}/{n_shards}", "--checkpoint", checkpoint,
                 "--resume", checkpoint, *options])
    merge = outline.modules.shell.Shell(
        "merge", range="1",
        command=["facet", "merge", *(f"{out}.{k}.ckpt" for k in range(1, n_shards + 1)), "-o", out])
    job.add_layer(render)
    job.add_layer(merge)
    merge.depend_all(render)
    return job


if __name__ == "__main__":
    if len(sys.argv) < 4 or not sys.argv[1].isdecimal():
        sys.exit(__doc__)
    outline.cuerun.launch(build(int(sys.argv[1]), sys.argv[2], sys.argv[3], sys.argv[4:]), use_pycuerun=False)

# Renders a scene as N shards and merges them, with as many at a time as -j says; what a stopped run has left is taken up:
#
#     make -f examples/farm/shards.mk -j 4 SCENE=scene.glb OUT=scene.exr N=16 OPTIONS='--spp 1024 --threads 4'
#
# SPDX-License-Identifier: MIT
FACET ?= facet
N ?= 4
parts := $(foreach k,$(shell seq $(N)),$(OUT).$(k).ckpt)

$(OUT): $(parts)
	$(FACET) merge $(parts) -o $@

# Always run: an unfinished shard is resumed, and a finished one ends at once.
$(parts): $(OUT).%.ckpt: always
	$(FACET) render $(SCENE) --shard $*/$(N) --checkpoint $@ --resume $@ $(OPTIONS)

.PHONY: always
.PRECIOUS: $(parts)

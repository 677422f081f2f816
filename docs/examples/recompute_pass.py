#!/usr/bin/env python3
"""Computes passes of a capture anew from the passes before them, with numpy alone, and compares bit for bit.

    python3 docs/examples/recompute_pass.py golden/box

A model for checking code of your own: read the input buffers, compute, compare. docs/capture.md has the rules. Exit code 1 if a bit differs.
"""
import json
import pathlib
import sys

import numpy as np

F = np.float32


class Capture:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.manifest = json.loads((self.folder / "manifest.json").read_text())
        self.buffers = {b["name"]: b for b in self.manifest["buffers"]}
        self.settings = self.manifest["settings"]

    def __contains__(self, name):
        return name in self.buffers

    def load(self, name):
        return np.load(self.folder / self.buffers[name]["file"])


def to_half(values, rounding):
    """Float to half: nearest_even is numpy's own, d3d rounds toward zero; what is finite stops at 65504."""
    largest = F(np.finfo(np.float16).max)
    values = np.where(np.isfinite(values), np.clip(values, -largest, largest), values)
    half = values.astype(np.float16)
    if rounding == "d3d":
        too_far = np.abs(half.astype(F)) > np.abs(values)
        half = (half.view(np.uint16) - too_far.astype(np.uint16)).view(np.float16)  # one step toward zero
    return half


def to_unorm16(values):
    return (np.clip(np.nan_to_num(values, nan=0.0), F(0), F(1)) * F(65535) + F(0.5)).astype(np.uint16)


def decoded(capture, name):
    """A stored LRSM texture as float32."""
    values = capture.load(name).astype(F)
    return values / F(65535) if capture.buffers[name]["encoding"] == "unorm" else values


def stored(capture, name, values):
    """float32 values in the buffer's own storage."""
    dtype = capture.buffers[name]["dtype"]
    if dtype == "f2":
        return to_half(values, capture.settings["layer_half_rounding"])
    return to_unorm16(values) if dtype == "u2" else values


def box(level):
    """2x2 box over rows and columns of (layer, row, column, component); pairs first, all in float32."""
    a, b, c, d = level[:, 0::2, 0::2], level[:, 0::2, 1::2], level[:, 1::2, 0::2], level[:, 1::2, 1::2]
    return F(0.25) * ((a + b) + (c + d))


def lrsm_base(capture):
    """RSM to mip 0 of the layers: which texels are in a layer, 2x2 of them merged."""
    settings = capture.settings
    for i, light in enumerate(capture.manifest["lights"]):
        radiance, normal, depth = (capture.load(f"rsm{i}.{part}").astype(F) for part in ("radiance", "normal", "depth"))
        drawn, n_dot_l = radiance[..., 3] > 0, normal[..., 3]
        partition, slices = light["partition"], settings["normal_layers"]
        first = sum((depth >= F(r["depth_max"])).astype(int) for r in partition[:-slices:slices])
        last = sum((depth >= F(r["depth_min"])).astype(int) for r in partition[slices::slices])
        cut = sum((n_dot_l >= F(r["n_dot_l_min"])).astype(int) for r in partition[1:slices])
        layers = {"radiance": [], "normal": [], "depth": []}
        for k, r in enumerate(partition):
            if r["stored"] is None:
                continue
            inside = (drawn & (first <= k // slices) & (k // slices <= last) & (cut == k % slices))[..., None]
            z = (depth - F(r["depth_min"])) / (F(r["depth_max"]) - F(r["depth_min"]))
            one, zero = np.ones_like(z), np.zeros_like(z)
            layers["radiance"].append(np.where(inside, np.concatenate([radiance[..., :3], zero[..., None]], axis=-1), F(0)))
            layers["normal"].append(np.where(inside, np.concatenate([normal[..., :3], one[..., None]], axis=-1), F(0)))
            layers["depth"].append(np.where(inside, np.stack([z, z * z, one, zero], axis=-1), F(0)))
        for part, values in layers.items():
            if values:
                yield f"lrsm{i}.{part}.mip0", stored(capture, f"lrsm{i}.{part}.mip0", box(np.stack(values)))


def lrsm_mips(capture):
    """Each mip of each LRSM texture from the stored mip below it."""
    for name in capture.buffers:
        texture, mip = name.rsplit(".mip", 1) if name.startswith("lrsm") else ("", "0")
        if mip != "0":
            below = f"{texture}.mip{int(mip) - 1}"
            yield name, stored(capture, name, box(decoded(capture, below)))


def blocks(level):
    """The 8 children of each texel: (z, y, x, ...) to a list of 8 arrays half as large, x fastest."""
    return [level[z::2, y::2, x::2] for z in (0, 1) for y in (0, 1) for x in (0, 1)]


def column_share(bits, level, axis):
    """Of the columns along an axis of bits (z, y, x), in blocks of 2^level voxels: the share that holds any, as UNORM8."""
    edge = 1 << level
    z, y, x = (n // edge for n in bits.shape)
    cells = bits.reshape(z, edge, y, edge, x, edge)
    covered = cells.max(axis=2 * axis + 1, keepdims=True).sum(axis=(1, 3, 5), dtype=np.uint32)
    return ((covered * 255 + edge * edge // 2) // (edge * edge)).astype(np.uint8)


def voxel_mips(capture):
    """UNORM8 mips of the voxels: level 1 and directional levels 2 and 3 from the bits, the others from the stored level below."""
    if capture.settings["voxel_storage"] != "gpu" or capture.settings["mip_filter"] != "mean":
        return
    n = capture.settings["voxel_resolution"]
    bits = np.unpackbits(capture.load("voxel.bits"), axis=2, bitorder="little")[:, :, :n]
    directional = capture.settings["opacity_axes"] == "directional"
    level = 1
    while n >> level >= 1:
        m = n >> level
        if directional and level <= 3:
            columns = [column_share(bits, level, axis) for axis in (2, 1, 0)]  # along x, y, z
            yield f"voxel.mip{level}", np.stack(columns, axis=-1)
        elif level == 1:
            count = sum(b.astype(np.uint32) for b in blocks(bits))
            yield "voxel.mip1", ((count * 255 + 4) >> 3).astype(np.uint8)
        else:
            codes = sum(b.astype(np.uint32) for b in blocks(capture.load(f"voxel.mip{level - 1}")))
            yield f"voxel.mip{level}", ((codes + 4) >> 3).astype(np.uint8)
        level += 1


def irradiance(capture):
    """Diffuse cones to irradiance: weights added ring by ring, set by set."""
    cones, rings = capture.load("cones.diffuse"), capture.manifest["cones"]["rings"]
    weights = [F(ring["weight"]) for ring in rings for _ in range(ring["count"])]
    sets = capture.settings["sets_per_pixel"]
    total = np.zeros(cones.shape[1:], F)
    for cone, values in enumerate(cones):
        total = total + weights[cone % len(weights)] * values
    per_set = F(1) / F(sets)
    yield "cones.irradiance", total[..., :3] * (F(capture.manifest["constants"]["pi"]) * per_set)
    yield "cones.opacity", total[..., 3] * per_set


def composite(capture):
    filtered = "filter.irradiance" if "filter.irradiance" in capture else "cones.irradiance"
    diffuse = capture.load("gbuffer.albedo") * capture.load(filtered) * (F(1) / F(capture.manifest["constants"]["pi"]))
    yield "composite.diffuse", diffuse
    yield "composite.combined", capture.load("direct.radiance") + diffuse + capture.load("composite.specular")


def results(compute, capture):
    """What a pass yields; nothing where the capture was made without its buffers."""
    try:
        yield from compute(capture)
    except KeyError as missing:
        print(f"{compute.__name__}: skipped, this capture has no {missing}")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    capture = Capture(sys.argv[1])
    different = 0
    for compute in (voxel_mips, lrsm_base, lrsm_mips, irradiance, composite):
        for name, values in results(compute, capture):
            golden = capture.load(name)
            assert values.dtype == golden.dtype and values.shape == golden.shape, (name, values.dtype, values.shape)
            count = np.count_nonzero(np.ascontiguousarray(values).view(np.uint8) != np.ascontiguousarray(golden).view(np.uint8))
            different += count > 0
            print(f"{name}: {'identical' if count == 0 else f'{count} bytes differ'}")
    sys.exit(1 if different else 0)


if __name__ == "__main__":
    main()

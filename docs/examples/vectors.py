#!/usr/bin/env python3
"""The paper's equations in NumPy, float32, held against exact results (docs/vectors.md):
lrsm validate --vectors DIR; vectors.py DIR; lrsm validate --against DIR"""
import json, math, sys
import numpy as np

folder, f4 = sys.argv[1], np.float32
sets = {s["name"]: s for s in json.load(open(f"{folder}/vectors.json"))["sets"]}
load = lambda name: [np.load(f"{folder}/{i['file']}") for i in sets[name]["inputs"]]
save = lambda name, result: np.save(f"{folder}/{name}.npy", result)
dot = lambda a, b: (a * b).sum(-1)
each = lambda a: a[:, None]  # a number a case beside an array a case

alpha, light = load("front_to_back")  # Eq. 1
clear = np.cumprod(1 - alpha, axis=1)
before = np.hstack([np.ones_like(alpha[:, :1]), clear[:, :-1]])
save("eq1.radiance", ((before * alpha)[..., None] * light).sum(1))
save("eq1.opacity", 1 - clear[:, -1])
rho, irradiance, cosine = load("reflected_radiance")  # Eq. 2
save("eq2.reflected_radiance", rho * irradiance * cosine / f4(math.pi))
x, n, l, light, omega, centre, radius, v = load("direct_sum")  # Eq. 3, 4, 7
inside = np.linalg.norm(x - each(centre), axis=-1) <= each(radius)
weight = np.where(inside, np.maximum(0, dot(n, each(v))) / dot(n, l), np.maximum(0, dot(l, each(v))))
total = (weight * omega).sum(1)
save("eq3.radiance", ((weight * omega * inside)[..., None] * light).sum(1) / each(np.where(total > 0, total, 1)))
save("eq4.weight", weight)
save("eq7.visibility", (omega * inside).sum(1) / omega.sum(1))
r, v, n = load("product")  # Eq. 5
save("eq5.radiance", r * v * n)
light, n, z, held, near, far = load("layer_texel")  # Eq. 6, 8, 10, 11, 14: means over the texels of a layer
held = held.astype(f4)
z = (z - near[:, None, None]) / (far - near)[:, None, None]
for name, what in {"eq6.radiance": light * held[..., None], "eq8.mean_normal": n * held[..., None], "eq10.alpha_z": z * held,
                   "eq11.alpha_z2": z * z * held, "eq14.coverage": held}.items():
    save(name, what.mean((1, 2)))
n, alpha, v = load("normal_term")  # Eq. 8
save("eq8.normal_term", np.maximum(0, dot(n, v)) / alpha)
u, v, level = load("sampler_weights")  # Eq. 9
tent = lambda t: np.maximum(0, 1 - np.abs(t))
save("eq9.weights", np.hstack([(tent(each(np.clip(level, 0, 3)) - lod) * (tent(each(v) * k - (np.arange(k, dtype=f4) + f4(0.5)))[:, :, None] *
     tent(each(u) * k - (np.arange(k, dtype=f4) + f4(0.5)))[:, None, :]).reshape(len(u), -1)).astype(f4) for lod, k in enumerate([8, 4, 2, 1])]))
z, z2, alpha = load("depth_moments")  # Eq. 10, 11
save("eq10.mean", z / alpha)
save("eq11.variance", np.maximum(z2 / alpha - (z / alpha) ** 2, f4(2.5e-5)))
phi = np.vectorize(lambda x: math.erfc(-x / math.sqrt(2)) / 2)  # Eq. 12
mu, sigma2, z, r = load("visibility")
with np.errstate(divide="ignore", invalid="ignore"):
    edge, sigma = np.abs(z - mu), np.sqrt(sigma2)
    save("eq12.visibility", np.where(sigma2 > 0, phi((r - edge) / sigma) - phi(-(r + edge) / sigma), np.sign(r - edge) / 2 + 0.5).astype(f4))
z, cosine, near, far, low, high = load("membership")  # Eq. 13
within = lambda x, a, b: (each(x) >= a) & ((each(x) < b) | ((each(x) == b) & (b == each(b.max(1)))))
save("eq13.membership", (within(z, near, far) & within(cosine, low, high)).astype(f4))
f, a, light = load("layer_sum")  # Eq. 14
save("eq14.radiance", ((f * a)[..., None] * light).sum(1))
near, far, delta, z = load("decay")  # Eq. 15
t = np.clip(np.minimum(z - near, far - z) / delta, 0, 1)
save("eq15.decay", np.where((z >= near) & (z < far), t * t * (3 - 2 * t), 0).astype(f4))

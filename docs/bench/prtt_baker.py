#!/usr/bin/env python3
"""Bakes transfer textures as the paper on them does ([T], algorithms 1 and 2), with Embree and numpy.

    python3 -m venv /tmp/prtt && /tmp/prtt/bin/pip install numpy embreex trimesh
    cargo run --release -p end-to-end --example export_obj -- builtin:paper-room 256 /tmp/room.obj
    /tmp/prtt/bin/python docs/bench/prtt_baker.py /tmp/room.obj --size 256 --rays 1024 -o /tmp/room

For every texel whose middle a triangle covers in the texture coordinates: position and normal (the G-buffer), N rays jittered over the
whole sphere, occlusion by Embree, and two projections to 25 spherical harmonics: V, the visibility above the surface, and V max(cos, 0),
which is transfer of diffuse surfaces before the division by pi. Then 3 dilations. Writes OUT-visibility.npy and OUT-cosine.npy
(rows x columns x 25, row 0 at v = 0) and prints texels, rays, seconds.

Only rays above the horizon are traced, as those below add nothing; both counts are printed. One process: embreex traces each batch on the
thread that calls it. `--processes P` cuts the texels into P parts. Texels share 64 jittered sets of directions, so that the projection is
a product of matrices; `--fresh` draws directions for each texel, as the paper has it, and evaluates harmonics for each visible ray. Before
the bake the same code bakes an open receiver and compares it with the closed form; a wrong coefficient ends the program with status 1.

Reads .obj with one index for v/vt/vn, or .npz with positions, normals, uv (n x 3, n x 3, n x 2) and triangles (m x 3).
"""

import argparse
import multiprocessing
import os
import sys
import time

# One thread for products of matrices as for rays: several are slower beside each other than one, and `--processes` says what is wanted.
for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")

import embreex.mesh_construction  # noqa: E402
import embreex.rtcore_scene  # noqa: E402
import numpy as np  # noqa: E402

BANDS = 5
# Rays that one batch holds: enough to hide the calls, small enough for the caches of most machines.
BATCH = 1 << 18
SETS = 64


def read_mesh(path):
    """Positions, normals, texture coordinates, triangles."""
    if path.endswith(".npz"):
        with np.load(path) as file:
            return tuple(file[name] for name in ("positions", "normals", "uv", "triangles"))
    numbers = {"v": [], "vt": [], "vn": []}
    corners = []
    with open(path, encoding="utf-8") as file:
        for line in file:
            words = line.split()
            if not words:
                continue
            if words[0] in numbers:
                numbers[words[0]].append([float(word) for word in words[1:4]])
            elif words[0] == "f":
                face = [[int(index) - 1 for index in word.split("/")] for word in words[1:]]
                corners.extend([face[0], face[k], face[k + 1]] for k in range(1, len(face) - 1))
    corners = np.array(corners)
    v, vt, vn = (np.array(numbers[key], dtype=np.float32) for key in ("v", "vt", "vn"))
    # One vertex for each triple that occurs.
    triples, triangles = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    return v[triples[:, 0]], vn[triples[:, 2]], vt[triples[:, 1], :2], triangles.reshape(-1, 3)


def g_buffer(positions, normals, uv, triangles, size):
    """Texel index (row * size + column), position, normal of every texel whose middle is covered."""
    corners = uv[triangles].astype(np.float64) * size - 0.5
    owner = np.full(size * size, -1)
    shares = np.zeros((size * size, 3))
    low = np.maximum(np.ceil(corners.min(axis=1) - 1e-9).astype(int), 0)
    high = np.minimum(np.floor(corners.max(axis=1) + 1e-9).astype(int), size - 1)
    for t in np.flatnonzero((low <= high).all(axis=1)):
        a, b, c = corners[t]
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if area == 0.0:
            continue
        x = np.arange(low[t, 0], high[t, 0] + 1)[None, :]
        y = np.arange(low[t, 1], high[t, 1] + 1)[:, None]
        second = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area
        third = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area
        first = 1.0 - second - third
        rows, columns = np.nonzero((first >= 0.0) & (second >= 0.0) & (third >= 0.0))
        places = (rows + low[t, 1]) * size + columns + low[t, 0]
        owner[places] = t
        shares[places] = np.stack([first[rows, columns], second[rows, columns], third[rows, columns]], axis=1)
    texels = np.flatnonzero(owner >= 0)
    of = triangles[owner[texels]]
    weights = shares[texels][:, :, None]
    place = (positions[of] * weights).sum(axis=1)
    normal = (normals[of] * weights).sum(axis=1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return texels, place.astype(np.float32), normal.astype(np.float32)


def harmonics(d):
    """The 25 real orthonormal functions without Condon-Shortley phase at unit directions (n x 3); index l (l + 1) + m."""
    x, y, z = d[:, 0], d[:, 1], d[:, 2]
    xx, yy, zz = x * x, y * y, z * z
    out = np.empty((25, len(d)), dtype=np.float32)
    out[0] = 0.28209479
    out[1], out[2], out[3] = 0.48860251 * y, 0.48860251 * z, 0.48860251 * x
    out[4], out[5], out[7] = 1.09254843 * x * y, 1.09254843 * y * z, 1.09254843 * x * z
    out[6], out[8] = 0.31539157 * (3 * zz - 1), 0.54627422 * (xx - yy)
    out[9], out[15] = 0.59004359 * y * (3 * xx - yy), 0.59004359 * x * (xx - 3 * yy)
    out[10], out[14] = 2.89061144 * x * y * z, 1.44530572 * z * (xx - yy)
    out[11], out[13] = 0.45704579 * y * (5 * zz - 1), 0.45704579 * x * (5 * zz - 1)
    out[12] = 0.37317633 * z * (5 * zz - 3)
    out[16], out[24] = 2.50334294 * x * y * (xx - yy), 0.62583574 * (xx * (xx - 3 * yy) - yy * (3 * xx - yy))
    out[17], out[23] = 1.77013077 * y * z * (3 * xx - yy), 1.77013077 * x * z * (xx - 3 * yy)
    out[18], out[22] = 0.94617470 * x * y * (7 * zz - 1), 0.47308735 * (xx - yy) * (7 * zz - 1)
    out[19], out[21] = 0.66904654 * y * z * (7 * zz - 3), 0.66904654 * x * z * (7 * zz - 3)
    out[20] = 0.10578555 * (35 * zz * zz - 30 * zz + 3)
    return out.T


def jittered_sphere(rays, random):
    """Directions over the sphere, one in each cell of a grid of equal solid angles; `rays` must be a square."""
    side = int(round(rays**0.5))
    if side * side != rays:
        raise SystemExit("--rays must be a square, such as 1024")
    cells = np.arange(side, dtype=np.float32)
    u = ((cells[:, None] + random.random((side, side), dtype=np.float32)) / side).ravel()
    v = ((cells[None, :] + random.random((side, side), dtype=np.float32)) / side).ravel()
    z = 1.0 - 2.0 * u
    r = np.sqrt(np.maximum(0.0, 1.0 - z * z))
    return np.stack([r * np.cos(2 * np.pi * v), r * np.sin(2 * np.pi * v), z], axis=1).astype(np.float32)


def embree(positions, triangles):
    scene = embreex.rtcore_scene.EmbreeScene()
    embreex.mesh_construction.TriangleMesh(scene, positions[triangles].astype(np.float32))
    return scene


def ray_sets(rays, random):
    """64 jittered sets of directions with their harmonics. Receivers share them, as evaluating harmonics costs more than tracing."""
    sets = [jittered_sphere(rays, random) for _ in range(SETS)]
    return [(directions, harmonics(directions)) for directions in sets]


def project(scene, places, normals, sets, chosen, epsilon):
    """Coefficients of V and of V max(cos, 0) at each place by the set chosen for it (2 x n x 25), and the number of rays traced."""
    out = np.zeros((2, len(places), BANDS * BANDS), dtype=np.float32)
    traced = 0
    rays = len(sets[0][0])
    group = max(1, BATCH // rays)
    for k, (directions, basis) in enumerate(sets):
        members = np.flatnonzero(chosen == k)
        for start in range(0, len(members), group):
            part = members[start : start + group]
            cosine = normals[part] @ directions.T
            receiver, ray = np.nonzero(cosine > 0.0)
            origins = (places[part] + epsilon * normals[part])[receiver]
            hit = scene.run(origins, directions[ray], query="OCCLUDED")
            visible = np.zeros(cosine.shape, dtype=np.float32)
            # embreex answers -1 where nothing is in the way.
            visible[receiver, ray] = hit == -1
            traced += len(ray)
            out[0, part] = visible @ basis
            out[1, part] = (visible * cosine) @ basis
    return out * np.float32(4.0 * np.pi / rays), traced


def fresh_sphere(receivers, rays, random):
    """Directions for each receiver of its own, jittered as in `jittered_sphere` (receivers x rays x 3)."""
    side = int(round(rays**0.5))
    cells = np.arange(side, dtype=np.float32)
    u = (cells[:, None] + random.random((receivers, side, side), dtype=np.float32)) / np.float32(side)
    v = (cells[None, :] + random.random((receivers, side, side), dtype=np.float32)) / np.float32(side)
    z = (1 - 2 * u).reshape(receivers, rays)
    angle = (np.float32(2 * np.pi) * v).reshape(receivers, rays)
    r = np.sqrt(np.maximum(np.float32(0), 1 - z * z))
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=2)


def project_fresh(scene, places, normals, rays, random, epsilon):
    """As `project`, with directions of its own for each receiver; harmonics are evaluated for visible rays only."""
    out = np.zeros((2, len(places), BANDS * BANDS), dtype=np.float32)
    traced = 0
    group = max(1, BATCH // rays)
    for start in range(0, len(places), group):
        part = slice(start, min(start + group, len(places)))
        count = part.stop - start
        directions = fresh_sphere(count, rays, random)
        cosine = np.einsum("rsk,rk->rs", directions, normals[part])
        receiver, ray = np.nonzero(cosine > 0.0)
        sent = directions[receiver, ray]
        origins = (places[part] + epsilon * normals[part])[receiver]
        seen = scene.run(origins, sent, query="OCCLUDED") == -1
        traced += len(ray)
        receiver, ray = receiver[seen], ray[seen]
        values = harmonics(sent[seen])
        # Visible rays stand in the order of their receivers: sums of runs, where a receiver has any.
        who, first = np.unique(receiver, return_index=True)
        if len(who):
            out[0, start + who] = np.add.reduceat(values, first, axis=0)
            out[1, start + who] = np.add.reduceat(values * cosine[receiver, ray][:, None], first, axis=0)
    return out * np.float32(4.0 * np.pi / rays), traced


def dilate(texture, filled, times):
    """Gives empty texels the mean of those of their eight neighbours that are filled."""
    size = len(texture)
    for _ in range(times):
        wide, mask = np.pad(texture, ((1, 1), (1, 1), (0, 0))), np.pad(filled, 1).astype(np.float32)
        total, count = np.zeros_like(texture), np.zeros((size, size), dtype=np.float32)
        for dy in range(3):
            for dx in range(3):
                near = mask[dy : dy + size, dx : dx + size]
                total += wide[dy : dy + size, dx : dx + size] * near[:, :, None]
                count += near
        new = ~filled & (count > 0)
        texture[new] = total[new] / count[new][:, None]
        filled = filled | new
    return texture


def open_receiver():
    """Zonal coefficients of the upper hemisphere, plain and with the cosine, about +z: integrals of P_l and x P_l over [0, 1]."""
    plain = [1.0, 1.0 / 2.0, 0.0, -1.0 / 8.0, 0.0]
    cosine = [1.0 / 2.0, 1.0 / 3.0, 1.0 / 8.0, 0.0, -1.0 / 48.0]
    factor = [2.0 * np.pi * ((2 * l + 1) / (4.0 * np.pi)) ** 0.5 for l in range(BANDS)]
    return [[f * value for f, value in zip(factor, values)] for values in (plain, cosine)]


def closed_form(normal, zonal):
    """The same about another axis: c_lm = sqrt(4 pi / (2 l + 1)) z_l Y_lm(n)."""
    y = harmonics(np.array([normal], dtype=np.float32))[0].astype(np.float64)
    degrees = np.repeat(np.arange(BANDS), 2 * np.arange(BANDS) + 1)
    return (4.0 * np.pi / (2 * degrees + 1)) ** 0.5 * np.array(zonal)[degrees] * y


def open_deviation(rays, normals, scale, fresh):
    """Largest deviation of the mean over as many receivers as sets from `scale` times the closed form, in standard errors of that mean."""
    far = np.array([[0, -1e6, 0], [1, -1e6, 0], [0, -1e6, 1]], dtype=np.float32)
    scene = embree(far, np.array([[0, 2, 1]]))
    random = np.random.default_rng(7)
    sets = None if fresh else ray_sets(rays, random)
    worst = 0.0
    for normal in normals:
        unit = (np.array(normal) / np.linalg.norm(normal)).astype(np.float32)
        many = np.repeat(unit[None, :], SETS, axis=0)
        if fresh:
            got, _ = project_fresh(scene, np.zeros_like(many), many, rays, random, np.float32(0.0))
        else:
            got, _ = project(scene, np.zeros_like(many), many, sets, np.arange(SETS), np.float32(0.0))
        for values, zonal in zip(got.astype(np.float64), open_receiver()):
            # Rounding of sums of so many numbers stands beside the spread of the sets.
            error = values.std(axis=0, ddof=1) / SETS**0.5 + 2e-6
            worst = max(worst, (np.abs(values.mean(axis=0) - scale * closed_form(unit, zonal)) / error).max())
    return worst


def check_itself(rays, fresh):
    """Ends the program unless the functions are orthonormal and an open receiver has the coefficients of the closed form, and not those of
    one 1 % brighter."""
    values = np.concatenate([basis for _, basis in ray_sets(1024, np.random.default_rng(3))]).astype(np.float64)
    skew = np.abs(4.0 * np.pi / len(values) * values.T @ values - np.eye(BANDS * BANDS)).max()
    print(f"harmonics: products integrate to 0 and 1 but for {skew:.5f} (at most 0.005)")
    axes = [(0, 0, 1), (0, 1, 0), (1, 0, 0), (0.3, -0.5, 0.8), (-0.6, 0.7, 0.1)]
    right, wrong = (open_deviation(rays, axes, scale, fresh) for scale in (1.0, 1.01))
    print(f"open receiver: {right:.1f} standard errors from the closed form (at most 5), {wrong:.0f} from one 1 % brighter")
    if not (skew <= 0.005 and right <= 5.0 < wrong):
        sys.exit("the baker is wrong")


def part_of_bake(arguments):
    positions, triangles, places, normals, rays, seed, epsilon, fresh = arguments
    random = np.random.default_rng(seed)
    if fresh:
        return project_fresh(embree(positions, triangles), places, normals, rays, random, epsilon)
    sets = ray_sets(rays, random)
    chosen = random.integers(SETS, size=len(places))
    return project(embree(positions, triangles), places, normals, sets, chosen, epsilon)


def bake(mesh, texels, rays, processes, fresh):
    """Coefficients (2 x n x 25), rays traced, seconds from the G-buffer to the last coefficient, Embree's tree included."""
    positions, _, _, triangles = mesh
    _, places, normals = texels
    epsilon = np.float32(1e-4 * np.linalg.norm(np.ptp(positions, axis=0)))
    start = time.perf_counter()
    if processes == 1:
        out, traced = part_of_bake((positions, triangles, places, normals, rays, 1, epsilon, fresh))
    else:
        parts = np.array_split(np.arange(len(places)), processes)
        jobs = [(positions, triangles, places[p], normals[p], rays, 1 + k, epsilon, fresh) for k, p in enumerate(parts)]
        with multiprocessing.Pool(processes) as pool:
            results = pool.map(part_of_bake, jobs, chunksize=1)
        out, traced = np.concatenate([r[0] for r in results], axis=1), sum(r[1] for r in results)
    return out, traced, time.perf_counter() - start


def main():
    parser = argparse.ArgumentParser(description="Bakes transfer textures with Embree and numpy.")
    parser.add_argument("mesh")
    parser.add_argument("--size", type=int, default=256, help="texels along a side")
    parser.add_argument("--rays", type=int, default=1024, help="rays of each texel over the sphere, a square")
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--fresh", action="store_true", help="directions of its own for each texel, not one of 64 sets")
    parser.add_argument("-o", "--out", default="prtt")
    options = parser.parse_args()
    check_itself(options.rays, options.fresh)
    mesh = read_mesh(options.mesh)
    start = time.perf_counter()
    texels = g_buffer(*mesh, options.size)
    buffered = time.perf_counter() - start
    out, traced, seconds = bake(mesh, texels, options.rays, options.processes, options.fresh)
    start = time.perf_counter()
    filled = np.zeros((options.size, options.size), dtype=bool)
    filled.flat[texels[0]] = True
    for name, values in zip(("visibility", "cosine"), out):
        texture = np.zeros((options.size, options.size, BANDS * BANDS), dtype=np.float32)
        texture.reshape(-1, BANDS * BANDS)[texels[0]] = values
        np.save(f"{options.out}-{name}.npy", dilate(texture, filled, 3))
    dilated = time.perf_counter() - start
    count = len(texels[0])
    print(f"{options.mesh}: {len(mesh[3])} triangles, {options.size} x {options.size} texels, of which {count} covered")
    print(f"{options.rays} rays a texel, {count * options.rays} in all, {traced} above the horizon and traced; {options.processes} process(es), {'own directions' if options.fresh else f'{SETS} sets of directions'}")
    print(f"G-buffer {buffered:.2f} s, rays and projection {seconds:.2f} s, dilation and files {dilated:.2f} s")
    print(f"{count / seconds:.0f} texels/s, {count * options.rays / seconds / 1e6:.3f} Mray/s of all, {traced / seconds / 1e6:.3f} Mray/s traced")
    print(f"mean share of the hemisphere seen {out[0, :, 0].mean() / 0.28209479 / (2 * np.pi):.4f}")


if __name__ == "__main__":
    main()

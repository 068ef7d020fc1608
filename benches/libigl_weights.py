"""libigl's bounded biharmonic weights in the terms of `weights.rs`: the same mesh, the same handles, 8 rounds.

    pip install numpy libigl
    python benches/libigl_weights.py MESH.obj [HANDLES]
    cargo bench --bench weights -- MESH.obj
"""

import sys
import time

import igl
import numpy as np


def read(path):
    """Vertices and triangles of an OBJ file."""
    points, faces = [], []
    with open(path) as lines:
        for words in map(str.split, lines):
            if words[:1] == ["v"]:
                points.append([float(x) for x in words[1:4]])
            elif words[:1] == ["f"]:
                faces.append([int(word.split("/")[0]) - 1 for word in words[1:4]])
    return np.array(points), np.array(faces, dtype=np.int64)


def far_apart(points, count):
    """Vertices far from each other and from where the mesh begins."""
    chosen = [0]
    distance = np.linalg.norm(points - points[0], axis=1)
    while len(chosen) < count:
        chosen.append(int(distance.argmax()))
        distance = np.minimum(distance, np.linalg.norm(points - points[chosen[-1]], axis=1))
    return np.array(chosen, dtype=np.int64)


def main():
    points, faces = read(sys.argv[1])
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 12
    handles = far_apart(points, count)
    for _ in range(2):
        wall, processor = time.perf_counter(), time.process_time()
        igl.bbw(points, faces, handles, np.eye(count), max_iter=8)
        wall, processor = time.perf_counter() - wall, time.process_time() - processor
        print(
            f"{len(points)} vertices: {1e3 * wall / count:.1f} ms a handle of {count}, "
            f"{1e3 * processor / count:.1f} ms of processor time"
        )


main()

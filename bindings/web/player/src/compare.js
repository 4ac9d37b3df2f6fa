// How far the vertices of one mesh are from those of another.

/** Distances of the vertices of `mesh` from those of the same number in `other`; undefined where there are not as many. */
export function distances(mesh, other) {
  const [a, b] = [mesh, other].map((m) => byVertex(m));
  if (a.length !== b.length) return undefined;
  return Float32Array.from(mesh.sourceVertices, (v) => Math.hypot(a[3 * v] - b[3 * v], a[3 * v + 1] - b[3 * v + 1], a[3 * v + 2] - b[3 * v + 2]));
}

function byVertex(mesh) {
  const { array } = mesh.geometry.attributes.position;
  const out = new Float32Array(3 * (1 + mesh.sourceVertices.reduce((most, v) => Math.max(most, v), 0)));
  mesh.sourceVertices.forEach((v, i) => out.set(array.subarray(3 * i, 3 * i + 3), 3 * v));
  return out;
}

// Numbers about the file, and its groups on the time line.

export function listFacts(list, { meshes, groups, rate, largest, attribute, range }) {
  list.replaceChildren();
  meshes.forEach((mesh, i) => {
    const { info } = mesh;
    const bytes = info.fileBytes;
    add(list, meshes.length > 1 ? ['first', 'second'][i] : 'name', mesh.name);
    add(list, 'bytes', bytes.toLocaleString('en'));
    add(list, 'vertices', info.maxVertices.toLocaleString('en'));
    add(list, 'frames', info.frameCount < info.totalFrames ? `${info.frameCount} of ${info.totalFrames}` : String(info.frameCount));
    add(list, 'bits a vertex and frame', ((8 * bytes) / info.maxVertices / info.frameCount).toFixed(3));
  });
  if (groups.length > 0) add(list, 'groups', String(groups.length));
  if (attribute) add(list, attribute.name, range ?? '');
  if (meshes.length > 1) add(list, 'largest distance', largest === undefined ? 'other vertices' : `${(100 * largest).toFixed(3)} % of size`);
  if (rate > 0) add(list, 'drawn a second', rate.toFixed(0));
}

function add(list, term, value) {
  const dt = Object.assign(document.createElement('dt'), { textContent: term });
  list.append(dt, Object.assign(document.createElement('dd'), { textContent: value }));
}

/** What is there of the frames, with a line where a group begins. */
export function drawGroups(canvas, groups, info) {
  const scale = globalThis.devicePixelRatio;
  canvas.width = canvas.clientWidth * scale;
  canvas.height = canvas.clientHeight * scale;
  const context = canvas.getContext('2d');
  const style = getComputedStyle(canvas);
  const place = (frame) => (canvas.width * frame) / Math.max(1, info.totalFrames);
  groups.forEach(({ firstFrame, frameCount }) => {
    context.fillStyle = style.getPropertyValue('--line');
    context.fillRect(place(firstFrame), 0, place(frameCount), canvas.height);
    context.fillStyle = style.getPropertyValue('--soft');
    context.fillRect(place(firstFrame), 0, scale, canvas.height);
  });
}

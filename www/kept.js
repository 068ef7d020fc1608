/** What a picture shows, written down, and how a Viewport is told of it. */

const PIN_STATES = { fixed: 0, proposed: 1, missing: 2 };

/** A picture of nothing. `skin` moves `mesh` instead of its poses; `camera` is null until the visitor moves it. */
export const nothing = () => ({ mesh: null, skin: null, time: -1, loop: false, paint: [['paint_clay']], boundaries: true, wireframe: false,
  contours: true, marks: new Map(), pins: [], camera: null, turn: null, dark: false, insets: [0, 0, 0, 0], room: [] });

/** Tells a new Viewport all of it. @param {() => void} frame looks at the whole motion */
export function tell(view, kept, frame) {
  view.set_theme(kept.dark);
  view.set_insets(...kept.insets);
  view.set_room(Float32Array.from(kept.room));
  view.set_loop(kept.loop);
  if (kept.mesh) {
    view.set_mesh(kept.mesh.faces, kept.mesh.reference);
    move(view, kept);
    if (kept.turn) turn(view, kept.turn);
    if (kept.camera) view.set_camera(kept.camera);
    else frame();
  }
  view.set_time(kept.time);
  view.set_boundaries(kept.boundaries);
  view.set_wireframe(kept.wireframe);
  view.set_contours(kept.contours);
  paintAll(view, kept.paint);
  for (const [style, faces] of kept.marks) view.mark_faces(faces, style);
  view.set_pins(pinNumbers(kept.pins));
}

/** Yaw and pitch of a camera's numbers. */
export const turnOf = (camera) => camera && [camera[3], camera[4]];

export function turn(view, [yaw, pitch]) {
  const camera = view.camera();
  camera.set([yaw, pitch], 3);
  view.set_camera(camera);
}

/** Has the skin or the poses move the mesh. */
export function move(view, { mesh, skin }) {
  if (skin) view.set_skin(skin.handles, skin.indices, skin.weights, skin.K, skin.matrices);
  else view.set_poses(mesh.poses);
}

/** Pins as the Viewport takes them. */
export const pinNumbers = (pins) => Float32Array.from(pins.flatMap(({ vertex = -1, face = -1, weights = [0, 0, 0], colour, state = 'fixed', selected, hovered }, i) =>
  [vertex, face, ...weights, colour ?? i, PIN_STATES[state], (selected ? 1 : 0) + (hovered ? 2 : 0)]));

/** Calls the Viewport's `paint_` methods, one after another. */
export function paintAll(view, paint) {
  for (const [method, ...values] of paint) view[method](...values);
}

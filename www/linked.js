/** Two pictures that are turned as one. */

/**
 * Lets two pictures look from the same side, each at its own figure.
 * @param {import('./stage.js').Stage} a @param {import('./stage.js').Stage} b turns as `a` is turned
 * @returns {() => void} ends it
 */
export function link(a, b) {
  let passing = false;
  const ends = [[a, b], [b, a]].map(([from, to]) => {
    const pass = ({ method, values }) => {
      if (passing) return;
      passing = true;
      if (method === 'camera') [to.camera] = values;
      else if (method === 'zoom') to.move('zoom', values[0], ...sameAside(from, to, values.slice(1)));
      else to.move(method, ...values);
      passing = false;
    };
    from.addEventListener('camera', pass);
    return () => from.removeEventListener('camera', pass);
  });
  b.turn = a.turn;
  return () => ends.forEach((end) => end());
}

/** The point that is as far from the middle of one picture as a point is from that of another. */
function sameAside(from, to, point) {
  const [before, after] = [from.middle, to.middle];
  return point.map((value, axis) => value - before[axis] + after[axis]);
}

/** Figures put together in one picture, as they lie on the screen. */

/** In a picture of a size of its own the halves lie over one another by this share of its width. */
const OVERLAP = 0.04;

/** Where figures lie on the screen, from the corner that they have in common: x, y, width and height in pixels. */
export function boxesOf(figures, ratio) {
  const boxes = figures.map(({ host }) => host.getBoundingClientRect());
  const left = Math.min(...boxes.map((box) => box.left));
  const top = Math.min(...boxes.map((box) => box.top));
  // Edges are rounded, not lengths: what meets on the screen meets here.
  const span = (from, to, start) => [Math.round(ratio * (from - start)), Math.round(ratio * (to - start))];
  return boxes.map((box) => {
    const [x, right] = span(box.left, box.right, left);
    const [y, bottom] = span(box.top, box.bottom, top);
    return [x, y, right - x, bottom - y];
  });
}

/** Boxes of two figures side by side in a picture of a size of its own. */
export function halves([width, height]) {
  const share = Math.round((width * (1 + OVERLAP)) / 2);
  return [[0, 0, share, height], [width - share, 0, share, height]];
}

/**
 * A canvas in which figures are put together, each in its box. As on the screen, a figure fades in over the one to its
 * left or above it: shadows do not end at an edge.
 */
export function together(boxes) {
  const canvas = blank(Math.max(...boxes.map(([x, , width]) => x + width)), Math.max(...boxes.map(([, y, , height]) => y + height)));
  const whole = canvas.getContext('2d');
  const layers = boxes.map(([, , width, height]) => blank(width, height));
  return {
    canvas,
    /** Has a figure look like this from now on. @param {CanvasImageSource} image */
    put(image, i) {
      const { width, height } = layers[i];
      const layer = layers[i].getContext('2d');
      layer.globalCompositeOperation = 'copy';
      layer.drawImage(image, 0, 0, width, height);
      if (i > 0) fadeIn(layer, boxes[i - 1], boxes[i]);
      layers.forEach((each, k) => whole.drawImage(each, boxes[k][0], boxes[k][1]));
    },
  };
}

const blank = (width, height) => Object.assign(document.createElement('canvas'), { width, height });

/** Lets what is drawn in a box begin softly where that lies over the one before. */
function fadeIn(layer, before, box) {
  const end = [0, 1].map((axis) => (box[axis] > before[axis] ? before[axis] + before[axis + 2] - box[axis] : 0));
  const share = layer.createLinearGradient(0, 0, ...end);
  share.addColorStop(0, 'transparent');
  share.addColorStop(1, 'black');
  layer.globalCompositeOperation = 'destination-in';
  layer.fillStyle = share;
  layer.fillRect(0, 0, layer.canvas.width, layer.canvas.height);
}

/** Kinds of screens; the styles have the same conditions. */

/** A phone or a tablet held upright, or a window as narrow: the panel is a sheet from below. */
export const NARROW = matchMedia('(max-width: 559px), (max-width: 720px) and (min-height: 481px), (max-width: 900px) and (orientation: portrait)');

/** A phone that lies on its side, or another low window: the panel takes half of the picture. */
export const LOW = matchMedia('(max-height: 480px) and (min-width: 560px), (max-height: 600px) and (min-width: 721px)');

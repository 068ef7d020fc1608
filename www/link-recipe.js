/** Recipes of creatures in a link: the name, and of the rest what differs from the default. */

const RECIPE = ['faces', 'poses', 'exact', 'motion', 'size', 'build', 'head', 'neck', 'legs', 'arms', 'tail'];

/** Of these there are whole numbers, from one to another. */
const COUNTS = { faces: [1_000, 1_000_000], poses: [1, 240] };
const within = (value, [low, high]) => Math.round(Math.min(Math.max(value, low), high));

/** The field that names a creature, and what comes before the names of the rest: of the source, and of the target. */
const SOURCE = ['zoo', ''];
export const TARGET = ['target', 'target.'];

/** Writes a recipe into the fields of a link. */
export function writeRecipe(fields, recipe, defaults, [key, prefix] = SOURCE) {
  fields[key] = recipe.name;
  for (const name of RECIPE) if (recipe[name] !== defaults[name]) fields[prefix + name] = recipe[name];
}

/** The recipe of the creature that a link names; null if it names none that exists. */
export function recipeOf(fields, { creatures, motions, recipe }, [key, prefix] = SOURCE) {
  if (!creatures.includes(fields[key])) return null;
  const wanted = { name: fields[key] };
  for (const name of RECIPE) {
    const text = fields[prefix + name];
    const value = typeof recipe[name] === 'string' ? text : parse(text);
    if (typeof value === typeof recipe[name]) wanted[name] = COUNTS[name] ? within(value, COUNTS[name]) : value;
  }
  if (!motions[creatures.indexOf(wanted.name)].includes(wanted.motion)) delete wanted.motion;
  return wanted;
}

/** A value as it stands in a link; `otherwise` where it is none. */
export function parse(text, otherwise = undefined) {
  try {
    return JSON.parse(text);
  } catch {
    return otherwise;
  }
}

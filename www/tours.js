/**
 * Guided tours: each opens a figure and walks through stops; a stop is a stage, a place in it where that matters, and a
 * few words. What a stop does not name stays as the visitor has it.
 *
 * @typedef {{step: string, view?: string, place?: 'first'|'last'|number, parts?: number|null, method?: string, moves?: boolean, run?: boolean,
 *   text: string}} Stop `run`: the positions of the stage go by on their own; `moves`: whether the figure moves
 * @typedef {{id: string, title: string, about: string, open: {zoo: string, faces?: number, target?: string}, stops: Stop[]}} Tour
 */

/** @type {Tour[]} */
export const TOURS = [
  {
    id: 'bend',
    title: 'Why parts bend where they do',
    about: 'From how one triangle turns to a horse in parts.',
    open: { zoo: 'horse' },
    stops: [
      { step: 'parts', view: 'parts', moves: true, text: 'A horse walks, and nobody has told the page where its joints are. All it has are places of points, two dozen times over. Every colour is a patch that keeps its shape. Where do they come from?' },
      { step: 'parts', view: 'gradients', moves: true, text: 'Begin with a single triangle beside a joint. Its three axes turn as the leg swings. What stays dark turns with it; what lights up has gone another way.' },
      { step: 'parts', view: 'deformation', moves: true, text: 'Compare every triangle with its neighbours, over all poses, and keep the worst. Joints light up by themselves: hips and knees, and a haze over the belly.' },
      { step: 'parts', view: 'sets', text: 'Draw a line: above ε is joint, below is limb. It is a crude question, and the answer depends on ε. Look at the histogram: there is no gap in it that would say where ε belongs.' },
      { step: 'parts', view: 'features', place: 'first', run: true, text: 'So ask for middles instead of borders: the triangle farthest from all joints, then the next, each with all that its warmth reaches.' },
      { step: 'parts', view: 'merging', place: 'first', run: true, text: 'Now join what moves as one, cheapest first. Watch how long nothing of importance happens, and how the last merges swallow whole limbs.' },
      { step: 'parts', view: 'parts', moves: true, text: 'That is why it bends where it does: these are the patches for which one rigid motion will do. The curve in the panel shows the price of one part less, and the slider cuts the same tree wherever you like.' },
    ],
  },
  {
    id: 'joints',
    title: 'Cutting at the joints',
    about: 'How a ragged border becomes a short line in the right place.',
    open: { zoo: 'dinosaur' },
    stops: [
      { step: 'parts', view: 'clusters', place: 'first', text: 'Every triangle went to the feature nearest to it. The patches are about right. Their borders are not: they follow the triangles, in zigzags.' },
      { step: 'parts', view: 'merging', place: 'last', text: 'At the end of merging there is but one part. Scrub back a little: each step to the left brings back the cut that was worth most.' },
      { step: 'parts', view: 'unsmoothed', text: 'Each triangle at a border asks which side explains its motion better. Those in red changed sides. This makes the parts as rigid as they can be, and the borders no prettier.' },
      { step: 'parts', view: 'cut', place: 0, text: 'Round each border lies a band. Within it any line would do, from the point of view of the parts: which is the cheapest? A short one, through what deforms.' },
      { step: 'parts', view: 'cut', place: 1, text: 'The minimal cut. It is found exactly, as the bottleneck of a flow from one side of the band to the other. The printed formula asks for the opposite of what the paper says; the lesson below shows which.' },
      { step: 'parts', view: 'parts', moves: true, text: 'Short lines, in the joints, at hardly any cost: compare the two residuals in the panel, before and after smoothing.' },
    ],
  },
  {
    id: 'points',
    title: 'Points that matter',
    about: 'A dozen points that carry a whole walk, and how they are found.',
    open: { zoo: 'person' },
    stops: [
      { step: 'keypoints', view: 'points', moves: true, text: 'These few points are all that is left of the walk: give each an affine map in every pose, and the rest of the body follows. Which points, and why these?' },
      { step: 'keypoints', view: 'spread', place: 'first', run: true, text: 'A hundred candidates, each as far as can be from those before it. The first ones find hands, feet and the top of the head without knowing what those are.' },
      { step: 'keypoints', view: 'candidates', place: 'first', run: true, text: 'Try them all, take the best, and again. Dark is good. See how each choice makes its own surroundings worthless for the next.' },
      { step: 'keypoints', view: 'replacement', place: 'first', run: true, text: 'The first choices were made in ignorance of the later ones. Each may now be given up for a better one.' },
      { step: 'keypoints', view: 'weights', text: 'A point carries what is near it, walked over the surface: the weight of a hand does not reach the hip it swings past. Press N for the next point.' },
      { step: 'keypoints', view: 'alternation', place: 'first', run: true, text: 'One pose, met from nothing: turn the groups, fit the maps, turn again. Each round is the best answer to half of the question, so the energy can only fall.' },
      { step: 'keypoints', view: 'points', moves: true, text: 'Drag the mark on the error curve: one point fewer, one more. Some of them matter a great deal more than others.' },
    ],
  },
  {
    id: 'two-bodies',
    title: 'One motion, two bodies',
    about: 'A camel that walks like a horse, by a handful of pairs.',
    open: { zoo: 'horse', target: 'camel' },
    stops: [
      { step: 'keypoints', view: 'points', moves: true, text: 'A horse in motion, and a camel that has never moved. They share no triangle. What they share are places: the tip of the nose, the knee, the tail.' },
      { step: 'target', view: 'points', text: 'So pair them. A point has one colour and one number on both. When you bring a figure of your own, the places are proposed, and you say which are right.' },
      { step: 'transfer', view: 'weights', text: 'Each body spreads the same points over its own surface. A place on the camel that is half knee, half hoof belongs to the place on the horse of which the same is true: weights are a language that both speak.' },
      { step: 'transfer', view: 'points', moves: true, text: 'Now hand over the motion. The camel walks. Drag a point on it, and the walk follows your hand: a few dozen matrices are quickly blended.' },
      { step: 'transfer', view: 'points', moves: true, method: 'direct', text: 'The paper hands the maps over just as they are. Look at the feet and the neck, where the two are built differently.' },
      { step: 'transfer', view: 'points', moves: true, method: '', text: 'Sinew finds the near-rigid bones in the horse’s motion first, finds them on the camel, and sets joint on joint. Take the result away under Export.' },
    ],
  },
  {
    id: 'poses',
    title: 'When the poses differ',
    about: 'The same walk, for a body that begins with its arms out.',
    open: { zoo: 'person', target: 'person-arms-out' },
    stops: [
      { step: 'target', view: 'points', text: 'Two bodies alike, but one rests with its arms down, the other with its arms out. All that is computed so far is relative to rest. What will a swing of the arm be, begun from elsewhere?' },
      { step: 'transfer', view: 'points', moves: true, method: 'direct', text: 'With the maps as they are, every arm is turned just as far as the other one was. But it began higher, so it ends higher. The motion is right and the pose is wrong.' },
      { step: 'transfer', view: 'points', moves: true, method: 'relative', text: 'Turning about the target’s own points mends where things are, not how they are turned: the arms keep their distance from the body.' },
      { step: 'transfer', view: 'points', moves: true, method: 'posed', text: 'To end alike, each part of the target has first to be brought into the pose that the source rests in, by a rotation P, and then to be deformed by S. For matrices that act from the left that is S·P. The printed Eq. 9 has it the other way round, and would deform first and turn the result. Compare the variants in the panel.' },
      { step: 'keypoints', view: 'alternation', place: 'last', text: 'Rotations again do all the work, as in the fit of a single pose. That is the thread through all of this: find what turns as one, and let it turn.' },
    ],
  },
];

export const tourNamed = (id) => TOURS.find((tour) => tour.id === id) ?? null;

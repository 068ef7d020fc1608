/**
 * The operations that a crew shares out: whether they are about the target or the source, how many members each is worth,
 * and what each member calls.
 */
export const shared = {
  keypoints: {
    target: false,
    members: (engine, { parameters }, most) => engine.members_for_search(parameters.points ?? parameters.max, most),
    run: (engine, { parameters }, progress, crew) => engine.keypoints(parameters, progress, crew),
  },
  fit: {
    target: false,
    members: (engine, { points }, most) => engine.members_for_weights(points.length, false, most),
    run: (engine, { points, parameters }, progress, crew) => engine.fit(points, parameters, crew),
  },
  target_weights: {
    target: true,
    members: (engine, { points }, most) => engine.members_for_weights(points.length, true, most),
    run: (engine, { points }, progress, crew) => engine.target_weights(points, crew),
  },
};

/** The operations that a crew shares out: how many members each is worth, and what each member calls. */
export const shared = {
  keypoints: {
    members: (engine, { parameters }, most) => engine.members_for_search(parameters.points ?? parameters.max, most),
    run: (engine, { parameters }, progress, crew) => engine.keypoints(parameters, progress, crew),
  },
  fit: {
    members: (engine, { points }, most) => engine.members_for_weights(points.length, false, most),
    run: (engine, { points, parameters }, progress, crew) => engine.fit(points, parameters, crew),
  },
  target_weights: {
    members: (engine, { points }, most) => engine.members_for_weights(points.length, true, most),
    run: (engine, { points }, progress, crew) => engine.target_weights(points, crew),
  },
};

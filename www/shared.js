/**
 * The operations that a crew shares out: whether they are about the target or the source, how many members each is worth,
 * and what each member calls. One with a `stage` has a single meeting, and its progress is that of the meeting.
 */
export const shared = {
  keypoints: {
    target: false,
    members: (engine, { parameters }, most) => engine.members_for_search(parameters.points ?? parameters.max, most),
    run: (engine, { parameters }, progress, crew) => engine.keypoints(parameters, progress, crew),
  },
  fit: {
    target: false,
    stage: 'weights',
    members: (engine, { points }, most) => engine.members_for_weights(points, false, most),
    run: (engine, { points, parameters }, progress, crew) => engine.fit(points, parameters, crew),
  },
  target_weights: {
    target: true,
    stage: 'weights',
    members: (engine, { points }, most) => engine.members_for_weights(points, true, most),
    run: (engine, { points }, progress, crew) => engine.target_weights(points, crew),
  },
};

/** A helper: runs one operation of the engine as a member of a crew. See crew.js. */
import init, { Engine } from '../pkg/worker.js';
import { Member } from './crew.js';
import { shared } from './shared.js';

let member;
self.addEventListener('message', ({ data }) => {
  if (member) member.hear(data);
  // What is wrong here is wrong for the leader, too, who says so.
  else help(data).catch(() => {});
});
self.postMessage({ meeting: -1 });

async function help({ module, kept, operation, payload, rank, size }) {
  member = new Member(rank, size);
  await init({ module_or_path: module });
  const engine = new Engine();
  if (shared[operation].target) engine.restore_target(kept);
  else engine.restore(kept);
  await shared[operation].run(engine, payload, () => {}, member);
}

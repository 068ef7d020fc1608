/** A helper: runs one operation of the engine as a member of a crew. See crew.js. */
import init, { Engine } from '../pkg/worker.js';
import { Member } from './crew.js';
import { shared } from './shared.js';

let member;
self.addEventListener('message', ({ data }) => {
  if (member) member.hear(data);
  else help(data);
});

async function help({ module, kept, operation, payload, rank, size }) {
  member = new Member(rank, size);
  await init({ module_or_path: module });
  const engine = new Engine();
  if (kept.source) engine.restore(kept.source);
  if (kept.target) engine.restore_target(kept.target);
  await shared[operation].run(engine, payload, () => {}, member);
}

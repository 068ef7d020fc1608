/**
 * Keeps the page for when there is no network. `VERSION` and `FILES` are written over this at the build.
 *
 * The network has the first word, so that a page is never older than its host; what it cannot bring comes from what was
 * kept of this very version.
 */
const CACHE = `sinew-${VERSION}`;
/** An answer that takes longer than this comes from what was kept, in milliseconds. */
const PATIENCE = 4000;

self.addEventListener('install', (event) => {
  const keep = async () => {
    const cache = await caches.open(CACHE);
    await cache.addAll(['./', ...FILES].map((name) => new Request(new URL(name, self.registration.scope), { cache: 'no-cache' })));
    await self.skipWaiting();
  };
  event.waitUntil(keep());
});

self.addEventListener('activate', (event) => {
  const clear = async () => {
    // Other pages of this host may keep things of their own.
    const old = (await caches.keys()).filter((name) => name.startsWith('sinew-') && name !== CACHE);
    await Promise.all(old.map((name) => caches.delete(name)));
    await self.clients.claim();
  };
  event.waitUntil(clear());
});

self.addEventListener('fetch', (event) => {
  const { request } = event;
  const url = new URL(request.url);
  if (request.method !== 'GET' || !url.href.startsWith(self.registration.scope)) return;
  const name = decodeURI(url.pathname.slice(new URL(self.registration.scope).pathname.length));
  if (name === '' || FILES.includes(name)) event.respondWith(answer(request));
});

async function answer(request) {
  const cache = await caches.open(CACHE);
  const kept = () => cache.match(request, { ignoreSearch: true, ignoreVary: true });
  const asked = fetch(request);
  const late = new Promise((resolve) => setTimeout(resolve, PATIENCE, null));
  try {
    const first = await Promise.race([asked, late]);
    if (first?.ok) return first;
    return (await kept()) ?? first ?? (await asked);
  } catch {
    return (await kept()) ?? Response.error();
  }
}

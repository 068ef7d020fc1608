/** Keeps the page for when there is no network, where the browser allows that. */

/** Asks for it once the page has settled, so that nothing the visitor waits for waits for this. */
export function keepOffline() {
  if (!navigator.serviceWorker || !['https:', 'http:'].includes(location.protocol)) return;
  const begin = () => navigator.serviceWorker.register(new URL('../sw.js', import.meta.url)).catch((error) => {
    // Some frames and private windows do not allow it; the page works all the same.
    console.info('Not kept for later:', error.message);
  });
  (window.requestIdleCallback ?? setTimeout)(begin, { timeout: 5000 });
}

/** Light and dark: as the system has it, until the visitor turns it. */

const KEY = 'sinew-theme';
const system = matchMedia('(prefers-color-scheme: dark)');

/** @param {(dark: boolean) => void} apply */
export function theme(apply) {
  const read = () => {
    try {
      return localStorage.getItem(KEY);
    } catch {
      return null; // Storage may be forbidden, for example in a frame.
    }
  };
  let chosen = read();
  const dark = () => (chosen ? chosen === 'dark' : system.matches);
  const show = () => {
    document.documentElement.dataset.theme = dark() ? 'dark' : 'light';
    apply(dark());
  };
  system.addEventListener('change', show);
  show();
  return function turn() {
    chosen = dark() ? 'light' : 'dark';
    try {
      localStorage.setItem(KEY, chosen);
    } catch {
      // It then holds for this visit only.
    }
    show();
  };
}

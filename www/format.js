/** Numbers as a person reads them: few digits, units, thin spaces between thousands. */

const whole = new Intl.NumberFormat('en', { maximumFractionDigits: 0 });

/** 12345 → “12,345”. */
export const count = (value) => whole.format(value);

/** “1 part”, “14 parts”. */
export const plural = (value, noun) => `${count(value)} ${noun}${value === 1 ? '' : 's'}`;

/** Three significant digits, without an exponent where that stays short. */
export function number(value, digits = 3) {
  if (value == null || Number.isNaN(value)) return '–';
  if (!Number.isFinite(value)) return value > 0 ? '∞' : '−∞';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size < 1e-3 || size >= 1e5) {
    const [mantissa, exponent] = value.toExponential(1).split('e');
    const power = `10${superscript(Number(exponent))}`;
    return mantissa === '1.0' ? power : `${mantissa}·${power}`;
  }
  return String(Number(value.toPrecision(digits))).replace('-', '−');
}

const superscript = (value) => [...String(value)].map((c) => (c === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[Number(c)])).join('');

/** 2345678 → “2.3 MB”. */
export function bytes(value) {
  if (value < 1e4) return `${(value / 1e3).toFixed(1)} kB`;
  if (value < 1e6) return `${Math.round(value / 1e3)} kB`;
  return value < 9.95e8 ? `${(value / 1e6).toFixed(1)} MB` : `${(value / 1e9).toFixed(1)} GB`;
}

/** A limit, in whole megabytes. */
export const megabytes = (value) => `${Math.round(value / (1 << 20))} MB`;

/** A share of one as a percentage. */
export function percent(share, digits = 1) {
  if (!Number.isFinite(share)) return '–';
  return `${(100 * share).toFixed(digits)} %`;
}

/** An error: a length over the size of the whole, in hundredths. */
export const ofSize = (value) => `${number(100 * value, 2)} %`;

/** “person-arms-out” → “Person arms out”. */
export const title = (name) => (name.charAt(0).toUpperCase() + name.slice(1)).replaceAll('-', ' ');

/** “0.4 s”, “12 s”, “2 min”. */
export function duration(seconds) {
  if (!Number.isFinite(seconds)) return '';
  if (seconds < 1) return `${Math.max(0.1, seconds).toFixed(1)} s`;
  if (seconds < 90) return `${Math.round(seconds)} s`;
  return `${Math.round(seconds / 60)} min`;
}

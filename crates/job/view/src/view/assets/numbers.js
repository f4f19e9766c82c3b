// Numbers for readers: three or four digits, always with a unit.
'use strict';

const Numbers = (() => {
  /** Most decimals of a number. */
  const DECIMALS = 6;
  const minus = (text) => text.replace('-', '\u2212');

  /**
   * Formats with `count` significant digits, never with an exponent. Returns '0' instead of a negative zero. `round` is
   * `Math.floor` for a lower bound and `Math.ceil` for an upper one.
   */
  function digits(value, count = 3, round = Math.round, mostDecimals = DECIMALS) {
    if (!Number.isFinite(value)) return value > 0 ? '\u221e' : '\u2212\u221e';
    if (value === 0) return '0';
    const power = Math.floor(Math.log10(Math.abs(value)) + 1e-9);
    const decimals = Math.min(mostDecimals, Math.max(0, count - 1 - power));
    // A value such as 20.4 may be stored as a little less.
    const hair = round === Math.round ? 0 : (round === Math.floor ? 1e-9 : -1e-9);
    const unit = 10 ** decimals;
    const text = (round(value * unit + hair) / unit).toFixed(decimals);
    // Zeros at the end of a very small number would claim a precision that it does not have.
    const short = power < 0 ? String(Number(text)) : text;
    return minus(short.includes('e') || Number(text) === 0 ? '0' : short);
  }

  /**
   * Formats a length in metres: millimetres below one metre, with at most three decimals unless that would be zero, as
   * the terminal does. `more` adds digits.
   */
  function length(metres, more = 0, round = Math.round) {
    if (Math.abs(metres) >= 0.9995) return `${digits(metres, 3 + more, round)} m`;
    const text = digits(1000 * metres, 3 + more, round, 3);
    return `${text === '0' ? digits(1000 * metres, 2, round) : text} mm`;
  }

  /** Returns a text of the terminal with angles in degrees alone: `-45.84 deg (-0.8000 rad)` becomes `\u221245.84\u00b0`. */
  const readable = (text) => text
    .replace(/(-?\d+(?:\.\d+)?) deg \(-?\d+(?:\.\d+)? rad\)/g, (_, degrees) => `${minus(degrees)}\u00b0`)
    .replace(/(-?\d+(?:\.\d+)?) rad\/s2/g, '$1 rad/s\u00b2');

  /** Formats an angle in radians as degrees with one decimal; `more` adds decimals. */
  function angle(radians, more = 0) {
    const text = ((radians * 180) / Math.PI).toFixed(1 + more);
    return `${minus(Number(text) === 0 ? text.replace('-', '') : text)}\u00b0`;
  }

  /** Formats a value of a joint. */
  const joint = ({ unit }, value, more = 0) => (unit === 'rad' ? angle(value, more) : length(value, more));

  /** Returns the unit of lengths in joint space; `in joint space` if the joints have different units. */
  const pathUnit = ([first, second]) => (first.unit === second.unit ? first.unit : 'in joint space');

  /** Formats a length in joint space, with the digits of the terminal. */
  const pathLength = (joints, value) => `${value.toFixed(4)} ${pathUnit(joints)}`;

  /** Formats a lower bound on a length in joint space, without its unit. */
  const below = (value) => (Math.floor(1e4 * value + 1e-9) / 1e4).toFixed(4);

  /** Formats a configuration: each joint with its name. */
  const configuration = (joints, q, more = 0) => joints.map((one, k) => `${one.name} ${joint(one, q[k], more)}`).join(', ');

  /** Formats a configuration in the units of files, radians and metres, for tooltips. */
  const exact = (joints, q) => joints.map((one, k) => `${one.name} ${minus(q[k].toFixed(4))} ${one.unit}`).join(', ');

  /** Formats a fraction as a percentage, never with an exponent. `round` is `Math.ceil` for an upper bound and `Math.floor` for a lower one. */
  function percent(fraction, round = Math.round) {
    const value = 100 * fraction;
    const power = value === 0 ? 0 : Math.floor(Math.log10(Math.abs(value)));
    // An upper bound has the digits that the terminal prints.
    if (round === Math.ceil && value > 0) {
      const places = value < 0.01 ? 3 : 2;
      return `${(Math.ceil(value * 10 ** places - 1e-9) / 10 ** places).toFixed(places)} %`;
    }
    const decimals = Math.min(4, Math.max(0, power < 0 ? 1 - power : 2 - power));
    const unit = 10 ** decimals;
    const rounded = round(value * unit) / unit;
    if (rounded === 0 && value > 0) return `below ${1 / unit} %`;
    return `${minus(String(Number(rounded.toFixed(decimals))))} %`;
  }

  const seconds = (value) => `${value.toFixed(2)} s`;

  return { digits, length, pathUnit, pathLength, below, angle, joint, configuration, exact, readable, percent, seconds };
})();

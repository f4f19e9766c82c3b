// Types of the scripts of a cell's page, for the type checker (`.ci/browser`).

interface Model {
  /** The data of two arms in one cell. */
  cell?: any;
}

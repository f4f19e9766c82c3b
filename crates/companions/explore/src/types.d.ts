// Types of the scripts of an exploration's page, for the type checker (`.ci/browser`).

interface Model {
  /** The data of an exploration, and the knowledge over time. */
  exploration?: any;
  survey?: any;
}

// Types of the page's scripts, for the type checker (`.ci/browser`). Pages do not contain this file.

/** A place in the plane, a spot on a canvas in pixels, or a configuration. */
type Point = number[];
/** Coordinates of several points, one after another. */
type Chain = number[];
/** A rectangle on a canvas, in pixels. */
interface Rect { x: number; y: number; width: number; height: number }
/** Draws on a panel. */
type Drawing = (context: CanvasRenderingContext2D, panel: Panel) => void;
/** Where a pointer is, and what kind of pointer: 'mouse', 'pen' or 'touch'. */
interface PointerPlace { clientX: number; clientY: number; pointerType: string }

/** The colours of the page's style sheet. Rust writes this constant before the scripts. */
declare const ROLES: string[];
/** The colours of the scale of values, from light to dark. Rust writes this constant, too. */
declare const SCALE_STOPS: string[];

interface Theme {
  [role: string]: any;
}

/** A joint of the arm. A revolute joint has a `sign`, a prismatic one a `direction`. */
interface Joint {
  name: string;
  unit: 'rad' | 'm';
  sign?: number;
  direction?: Point;
  domain: [number, number];
  circle: boolean;
  velocity: number;
  acceleration: number;
  torque?: number;
}

/** A convex shape: corners and a radius around them. */
interface ConvexShape { points: Chain; radius: number }

interface ArmPart extends ConvexShape { body: string }

/** The arm: its kinematics and the shapes of both links. */
interface ArmModel {
  name: string;
  kind: string;
  joints: [Joint, Joint];
  one_scale: boolean;
  links: { name: string; parts: any[] }[];
  base: Point;
  offset: Point;
  tip: Point;
  reach: any;
  plane: [string, string];
}

/** An obstacle. Pieces after the first `own` are used for collisions with a payload instead. */
interface ObstacleModel { name: string; color: string; outline: any; own: number; pieces: any[] }

/** A world in which the arm moves. */
interface WorldModel {
  label: string;
  clearance: number;
  obstacles: ObstacleModel[];
  movers?: any[];
  payload?: any;
  pairs: number[][];
  c_obstacles: { obstacle: number; link: number; contour: Chain }[];
  moments?: any[];
  regions: any[];
  trace?: any;
  scale?: any;
  proof: Chain;
  unreached: Point[];
}

/** A path in a world. */
interface PathModel { name: string; world: number; color?: string; width: number; dash: number[]; points: Chain; ghosts: Chain; step?: number }

/** A motion from rest to rest: `round` is the number of the step's repetition, `replay` that of the planner's replay. */
interface MotionModel { world: number; path: number | null; from: number; label: string; round?: number; clearance?: number; replay?: number }

/** The arm's configuration as a function of time. */
interface ClockModel { time: number[]; position: Chain; velocity: Chain; acceleration: Chain; torque?: Chain }

/** A phase of the planner's replay. */
interface PhaseModel { seconds: number; caption: string; length?: number; unit?: string; rounds?: { lower: number; points: Chain; slices: number[] }[]; [name: string]: any }

/** A wait of the motion for a moving obstacle. `at` is the progress. */
interface WaitModel { from: number; to: number; at: number; text: string }

/** Progress along a motion against time, with the regions that moving obstacles block. */
interface StripModel {
  duration: number;
  obstacles: { name: string; color: string; regions: Chain[] }[];
  motion: Chain;
  waits: WaitModel[];
}

/** The height of the tool in millimetres against time. */
interface HeightModel { joint: string; duration: number; motion: Chain }

/** The angle in degrees by which the wrist has turned the carried object against time, and for each turn the orientations in radians. */
interface TurnsModel { joint?: string; is_empty?: boolean; duration: number; motion: Chain; turns: Chain[] }

/** The angle of the tool from the x axis in degrees against time, of all lines and of each. */
interface ToolAngleModel { joint?: string; duration: number; motion: Chain; lines: Chain[] }

/** Key figures of a result. */
interface FiguresModel { duration?: number; gap?: number; fastest?: boolean; clearance?: number; with_clearance?: [number, number] }

/** Two bodies, and where they come nearest to a contact. */
interface PlaceModel { between?: [string, string]; at?: Point; time?: number }

/** The proven clearance of a body in metres, or `null` if it can meet none. */
interface MarginModel extends PlaceModel { body: string; kind: string; clearance: number | null }

/** The largest error of a kind, or `null` if no error leads to contact. */
interface ToleranceModel extends PlaceModel { of: string; unit: string; error: number | null }

/** A card of an explanation: a change of the world with the path that it opens, or a configuration to look at. */
interface Card {
  /** The change as an instruction. */
  title: string;
  /** The amount that opens a path, that which does not, and anything else that is known. */
  opens?: string;
  closed?: string;
  note?: string;
  /** Index of the changed obstacle, and the obstacle after the change. */
  obstacle?: number;
  changed?: ObstacleModel;
  /** Indices of the obstacles that are not there. */
  removed?: number[];
  /** C-obstacles after the change, and ranges of both joints. */
  c_obstacles?: WorldModel['c_obstacles'];
  domains?: [number, number][];
  path?: PathModel;
  /** True if the card shows a place, and nothing that helps. */
  is_place?: boolean;
  at?: Point;
  /** The change of the world file. */
  edit?: { obstacle?: { number: number; shape: any }; removal?: number; clearance?: number; limits?: { joint: number; range: Point } };
}

/** Why there is no path, or what makes it longer. */
interface ExplanationModel { headline: string; evidence: string; title: string; cards: Card[]; frame: [Point, Point]; stuck?: any }

/** A line that the tip should follow, with the images under its IK solutions, and the place where it cannot be followed. */
interface LineModel {
  strokes: Chain[];
  /** Replaced and failing moves of a program, each with its colour. */
  marked?: [string, Chain][];
  /** Exact curves: two ends; centre, radius, direction, angle, and perhaps growth of the radius; or four control points. */
  curves?: number[][];
  tolerance: number;
  /** Radius of the lens, metres. */
  lens: number;
  at?: Point;
  excluded: Point[];
  solutions: { solution: number; excluded: boolean; points: Chain }[];
  names: string[];
  motion?: {
    /** Proven bound on the distance from the line, metres. */
    deviation: number;
    /** Time and distance of the place that is farthest from the line. */
    farthest: [number, number];
    limits: [string, string][];
    /** Ends of the stretches, each with the index of its limit. */
    stretches: [number, number][];
    stops: number[];
    /** Least and greatest distance in equal intervals of time, in thousandths of the tolerance. */
    deviations: [number, number][];
    speeds: Chain;
  };
  focus?: { ranges: [Point, Point]; corner: Point };
  smooth?: boolean;
}

/** The data of a page. */
interface Model {
  title: string[];
  status: string;
  ending: string;
  facts: [string, string][];
  figures?: FiguresModel;
  arm: ArmModel;
  frame: [Point, Point];
  start: Point;
  goals: Point[];
  goal_lines: any[];
  worlds: WorldModel[];
  paths: PathModel[];
  motions: MotionModel[];
  clock: ClockModel | null;
  frames: any[];
  strip?: StripModel;
  height?: HeightModel;
  turns?: TurnsModel;
  tool?: ToolAngleModel;
  replay?: PhaseModel[];
  replays?: { phases: PhaseModel[]; trace?: any; scale?: any }[];
  legend: any[];
  stuck?: any;
  explanation?: ExplanationModel;
  budget?: { margins: MarginModel[]; tolerances: ToleranceModel[] };
  checked?: any;
  reach?: any;
  line?: LineModel;
  /** Objects where a task puts them. */
  places?: ObstacleModel[];
}

/** The pair of an arm's part and an obstacle that is in contact or nearest. */
interface ContactModel { link: number; body: string; carried: boolean; obstacle: number; distance: number; [name: string]: any }

/** A handler that receives pointer events before the view. */
interface Tool {
  down(panel: Panel, value: Point, event: PointerEvent): boolean;
  move(panel: Panel, value: Point, event: PointerEvent): boolean;
  up(panel: Panel, value: Point, event: PointerEvent): boolean;
  /** A finger has tapped on nothing. */
  tap(panel: Panel): void;
  /** Returns true if there is something to take. */
  grasps(panel: Panel, value: Point, event: PointerPlace): boolean;
}

interface Window { cplan: any; inspection: any }
declare const cplan: any;

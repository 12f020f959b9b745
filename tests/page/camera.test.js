// The camera beside a frame that moves: what hands do to it is as at rest.

import assert from "node:assert/strict";
import { test } from "node:test";

/** What camera.js uses of three.js. */
class Vector {
  /** @param {number[]} at */
  constructor(at = [0, 0, 0]) {
    this.at = [...at];
  }
  clone = () => new Vector(this.at);
  toArray = () => [...this.at];
  /** @param {number[]} at */
  set(...at) {
    this.at = at;
    return this;
  }
  /** @param {Vector} other */
  copy = (other) => this.set(...other.at);
  /** @param {Vector} other @param {number} k */
  addScaledVector = (other, k) => this.set(...this.at.map((v, i) => v + k * other.at[i]));
  /** @param {Vector} other */
  sub = (other) => this.addScaledVector(other, -1);
  /** @param {Vector} other */
  dot = (other) => this.at.reduce((sum, v, i) => sum + v * other.at[i], 0);
  normalize = () => this.set(...this.at.map((v) => v / Math.hypot(...this.at)));
  /** @param {Vector} other */
  setFromMatrixPosition = (other) => this.copy(other);
  get x() {
    return this.at[0];
  }
  get y() {
    return this.at[1];
  }
  get z() {
    return this.at[2];
  }
}

/** @param {number[]} at @param {number} yaw */
const turned = ([x, y, z], yaw) => [
  Math.cos(yaw) * x - Math.sin(yaw) * y,
  Math.sin(yaw) * x + Math.cos(yaw) * y,
  z,
];

/** The camera-controls of viser, in a world whose vertical is z. */
const controls = {
  target: new Vector(),
  away: [1, 0, 0],
  get distance() {
    return Math.hypot(...this.away);
  },
  /** @param {Vector} into */
  getTarget: (into) => into.copy(controls.target),
  /** @param {Vector} into */
  getPosition: (into) => into.copy(controls.target).addScaledVector(new Vector(controls.away), 1),
  /** @param {number[]} at */
  moveTo: (...at) => controls.target.set(...at.slice(0, 3)),
  /** @param {number} yaw */
  rotate: (yaw) => (controls.away = turned(controls.away, yaw)),
  /** @param {number} to */
  dollyTo(to) {
    const by = to / this.distance;
    this.away = this.away.map((part) => part * by);
  },
  /** @param {number[]} at */
  setLookAt(...at) {
    this.target.set(...at.slice(3, 6));
    this.away = new Vector(at.slice(0, 3)).sub(this.target).at;
  },
  updateCameraUp() {},
};

/** The frame that is followed. */
const robot = {
  position: [0, 0, 0],
  yaw: 0,
  updateWorldMatrix() {},
  get matrixWorld() {
    return new Vector(this.position);
  },
  /** @param {Vector} point */
  localToWorld(point) {
    return point.set(...turned(point.at, this.yaw).map((v, i) => v + this.position[i]));
  },
};
const same = (/** @type {Vector} */ point) => point;
const view = {
  camera: { position: new Vector(), up: new Vector([0, 0, 1]), updateProjectionMatrix() {} },
  cameraControl: controls,
  canvas: { clientHeight: 600 },
  nodeRefFromName: { "": { localToWorld: same, worldToLocal: same }, "/robot": robot },
};
Object.assign(globalThis, { window: { __viserMutable: view } });
// Each picture is late enough to be reported.
let clock = 0;
performance.now = () => (clock += 1000);
const { loseCamera, moveCamera, reportCamera, takeCamera } =
  await import("../../src/sambot_viz/page/view/camera.js");

/** @type {any} */
let report = null;
reportCamera((sent) => (report = sent));

/** The server asks for a camera that looks from 2 m. @param {number} number @param {number} yaw */
function ask(number, yaw) {
  const position = turned([2, 0, 0], yaw);
  takeCamera(
    /** @type {any} */ ({
      number,
      follows: { node: "/robot", place: true, turns: true, at: [0, 0, 0, 0] },
      camera: {
        position,
        look_at: [0, 0, 0],
        up: [0, 0, 1],
        fov: 0.8,
        near: 0.01,
        far: 100,
        scale: null,
      },
    }),
  );
}

/** What is reported relative to the frame: distance, yaw, and the point that is looked at. */
function numbers() {
  const [x, y, z] = new Vector(report.position).sub(new Vector(report.look_at)).at;
  return [Math.hypot(x, y, z), Math.atan2(y, x), ...report.look_at];
}

/** @param {number[]} found @param {number[]} wanted */
function near(found, wanted) {
  found.forEach((v, i) => assert.ok(Math.abs(v - wanted[i]) < 1e-9, `${found} ≠ ${wanted}`));
}

/** A new camera, 2 m from the frame, which goes on before each picture. @param {number} speed */
function begin(speed) {
  loseCamera();
  Object.assign(robot, { position: [3, -1, 0.2], yaw: 0.4 });
  ask(1, 0.3);
  moveCamera();
  return () => {
    robot.position = robot.position.map((part) => part + speed);
    robot.yaw += speed;
    moveCamera();
  };
}

test("the camera that was asked for is relative to the frame, and stays so while it moves", () => {
  const picture = begin(0.1);
  near(numbers(), [2, 0.3, 0, 0, 0]);
  for (let i = 0; i < 30; i += 1) picture();
  near(numbers(), [2, 0.3, 0, 0, 0]);
});

for (const speed of [0, 0.03, 1])
  test(`five notches and a drag beside a frame that moves ${speed} m a picture`, () => {
    const picture = begin(speed);
    for (let i = 0; i < 5; i += 1) {
      controls.dollyTo(controls.distance * 0.9);
      controls.rotate(-0.1);
      picture();
    }
    assert.equal(report.camera, 1);
    near(numbers(), [2 * 0.9 ** 5, 0.3 - 0.5, 0, 0, 0]);
  });

test("a drag goes on from a camera that the server asks for in the middle of it", () => {
  const picture = begin(0.03);
  controls.rotate(-0.1);
  picture();
  ask(2, 1.2);
  picture();
  near(numbers(), [2, 1.2, 0, 0, 0]);
  controls.rotate(-0.1);
  picture();
  assert.equal(report.camera, 2);
  near(numbers(), [2, 1.1, 0, 0, 0]);
});

for (const speed of [0, 0.03])
  test(`a hand between what was asked for and its picture counts, beside ${speed} m a picture`, () => {
    const picture = begin(speed);
    ask(2, 1.2);
    controls.rotate(-0.1);
    controls.dollyTo(controls.distance * 0.9);
    picture();
    assert.equal(report.camera, 2);
    near(numbers(), [1.8, 1.1, 0, 0, 0]);
  });

test("of cameras that come before a picture the last one is shown", () => {
  const picture = begin(0.03);
  ask(2, 1.2);
  ask(3, 0.7);
  picture();
  assert.equal(report.camera, 3);
  near(numbers(), [2, 0.7, 0, 0, 0]);
});

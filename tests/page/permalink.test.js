import assert from "node:assert/strict";
import { test } from "node:test";

// What the page's scripts want of a browser when they are read.
Object.assign(globalThis, { localStorage: { getItem: () => null, setItem: () => {} }, window: {} });
const { addressOf, isPermalink, partsOf } =
  await import("../../src/sambot_viz/page/wire/permalink.js");
const page = { origin: "https://lab.example.org", pathname: "/robot/" };

test("a link is read as it was written, whatever the names", () => {
  const parts = [
    ["view", "Orbit"],
    ["view.Focal Point", "0,1.5,-2"],
    ["j.left wheel+=%&#/\u00e9", "1e-7"],
    ["show.TF/Frames/=a", "0"],
    ["select", "link:a"],
    ["select", "link:b"],
    ["v", "1"],
  ];
  const address = addressOf(parts, page);
  assert.deepEqual(partsOf(new URL(address).hash), [
    parts.map(([name]) => name),
    parts.map(([, value]) => value),
  ]);
});

test("a link keeps the path of a proxy, leaves the query away, and can be read", () => {
  assert.equal(
    addressOf(
      [
        ["view", "Orbit"],
        ["view.Focal Point", "0,1,2"],
        ["select", "link:a"],
        ["v", "1"],
      ],
      page,
    ),
    "https://lab.example.org/robot/#view=Orbit&view.Focal+Point=0,1,2&select=link:a&v=1",
  );
});

test("links that were written by hand are opened, other ends of addresses are not", () => {
  for (const end of ["j.arm_joint=0.5&v=1", "robot=sam_bot&j.a=1", "v=1", "show.Grid=0&v=1"])
    assert.ok(isPermalink(`#${end}`), end);
  for (const end of ["", "#", "#top", "#review=1", "#a=1&b=2"]) assert.ok(!isPermalink(end), end);
});

// @ts-check
/* Pictures of the classes of displays, as outlines on a grid of 16 by 16. */

const POINTS =
  "M2.5 11.5h.6M5 8h.6M4 4h.6M7.5 11h.6M8.5 6h.6M7.5 2.5h.6M11 9h.6M12 4h.6M13 12h.6M9.5 13.8h.6M4.8 14h.6";

/** @type {Record<string, string>} */
export const DISPLAY_ICONS = {
  AccelStamped: "M2 14l6-6M8 8v3.8M8 8H4.2M8 8l6-6M14 2v3.8M14 2h-3.8",
  Axes: "M4 12V3M4 12h9M4 12l4-4",
  Camera: "M1.5 4.5h3l1-1.5h5l1 1.5h3V13h-13zM8 6a2.7 2.7 0 1 0 .01 0",
  CameraInfo: "M1.5 8l8-5.5v11zM9.5 2.5l5 2.5v6l-5 2.5",
  DepthCloud: "M1.5 3h13v10h-13zM4.5 6h.6M8 6h.6M11.5 6h.6M4.5 10h.6M8 10h.6M11.5 10h.6",
  Effort: "M13.5 8a5.5 5.5 0 1 1-1.8-4M12 1.2V4.2H9M7.7 8h.6",
  FluidPressure: "M3.5 13a6.5 6.5 0 1 1 9 0M8 10l3-4.5M7.7 10.3h.6",
  Grid: "M1.5 8L8 4l6.5 4L8 12zM4.7 6l6.6 4M11.3 6l-6.6 4",
  GridCells: "M2 6h4v4H2zM6 2h4v4H6zM6 10h4v4H6zM10 6h4v4h-4z",
  Group: "M1.5 4h4l1.5 1.5h7.5V13h-13z",
  Illuminance: "M6 11.5c0-1.6-2-2.5-2-5a4 4 0 0 1 8 0c0 2.5-2 3.4-2 5zM6.3 14.2h3.4",
  Image: "M1.5 3h13v10h-13zM1.5 11l4-4 3.5 3.5 2-2 3.5 3M11 5.8h.6",
  InteractiveMarkers:
    "M8 4.5a3.5 3.5 0 1 0 .01 0M.8 8h3.7M.8 8l1.7-1.7M.8 8l1.7 1.7M15.2 8h-3.7M15.2 8l-1.7-1.7M15.2 8l-1.7 1.7",
  LaserScan:
    "M8 13.5L3.2 6M8 13.5L12.8 6M7.7 13.5h.6M1 8h.6M2.6 4.4h.6M5.5 2.4h.6M10 2.4h.6M12.8 4.4h.6M14.4 8h.6",
  Map: "M2 2h12v12H2zM2 7h4.5V4.7M9 14V9.5h5M10.5 2v3.2",
  Marker: "M8 2l5.5 3v6L8 14l-5.5-3V5zM2.5 5L8 8l5.5-3M8 8v6",
  MarkerArray:
    "M5.2 1.2l4 2v4.4l-4 2-4-2V3.2zM1.2 3.2l4 2 4-2M5.2 5.2v4.4M11.5 8.5a3 3 0 1 0 .01 0",
  Odometry: "M2 14c1-7 6-1 7.5-7.2L14 2M14 2h-3.8M14 2v3.8",
  ParticleCloud:
    "M2.5 4.5l2.6-1.7M8 3.5l3 .6M2 9.5l3-1.2M7.8 9.4l2-2.3M12 9l2.6-1.6M4 14l2.6-1.7M9.8 13.6l3-.9",
  Path: "M2 13c3 0 2-5 5-5s2-5 7-5",
  PointCloud: POINTS,
  PointCloud2: POINTS,
  PointStamped: "M8 14.5c3-3.8 4.5-6 4.5-8.2a4.5 4.5 0 0 0-9 0c0 2.2 1.5 4.4 4.5 8.2zM7.7 6.3h.6",
  Polygon: "M8 2l6 4.5-2.3 7H4.3L2 6.5z",
  Pose: "M2 8h11M9 4l4 4-4 4",
  PoseArray: "M1.5 4h8M7.2 2l2.3 2-2.3 2M6 8h8M11.7 6L14 8l-2.3 2M1.5 12h8M7.2 10l2.3 2-2.3 2",
  PoseWithCovariance: "M1.2 8a6.8 5 0 1 0 13.6 0a6.8 5 0 1 0-13.6 0M4.2 8h7M9 5.8L11.2 8 9 10.2",
  Range: "M1.5 8l10-4.8M1.5 8l10 4.8M11.5 3.2c2.6 2.6 2.6 7 0 9.6",
  RelativeHumidity: "M8 2c3 3.7 4.5 5.8 4.5 8a4.5 4.5 0 0 1-9 0c0-2.2 1.5-4.3 4.5-8z",
  RobotModel:
    "M5 5h6v5H5zM8 5V2.5M6.5 7.2v.6M9.5 7.2v.6M6.5 10v3.5M9.5 10v3.5M5 7H3v2.5M11 7h2v2.5",
  TF: "M3 13V8M3 13h5M3 13l3-3M13 3v4M13 3h-4M6 10l5-5",
  Temperature: "M6.2 9V3.3a1.8 1.8 0 0 1 3.6 0V9a3.2 3.2 0 1 1-3.6 0zM8 6.5v5",
  TwistStamped: "M3 13L13 3M13 3H9M13 3v4M2.5 7a4.5 4.5 0 0 1 4.5-4.5M13.5 9.5A4.5 4.5 0 0 1 9 14",
  Wrench: "M8 14.5V1.8M8 1.8L5.2 4.6M8 1.8l2.8 2.8M2.5 9a5.5 2.8 0 0 0 11 0",
};

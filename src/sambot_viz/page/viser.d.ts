// What our scripts use of viser's page. viser 1.1 keeps it there for its own tests.

interface Window {
  __viserMutable?: {
    sendMessage(message: { type: string; [field: string]: unknown }): void;
    requestRender?(): void;
    canvas: HTMLCanvasElement;
    messageQueue: any[];
    /** Has viser take what is in the queue. */
    drainMessageQueue: (() => void) | null;
    firstMessageBatch: boolean;
    /** Objects of three.js and camera-controls have no types here. */
    scene: any;
    camera: any;
    cameraControl: any;
    backgroundMaterial: any;
    nodeRefFromName?: Record<string, any>;
  };
  /** What the window tells the scripts that draw and move the view. */
  sambotViz?: {
    view?: { kind: string; focalSize: number; focalFixed: boolean };
    /** Whether controls of interactive markers are visible. */
    controls?: boolean;
  };
  /** What rviz_look.js has changed, for tests. */
  sambotPermalink?: string;
  /** The address of the page's own websocket. */
  sambotSocket?: string;
  /** viser's connection: opened when `open` is called, and at first (viser_address.js). */
  sambotViser?: {
    state: "opening" | "open" | "closed";
    open(): void;
    changed: (state: "open" | "closed") => void;
  };
  /** Takes apart what has moved (viser_poses.js). */
  sambotPoses?: { unpacked(messages: any[]): any[]; clear(): void };
  sambotVizLook?: Record<string, number>;
  /** Which camera is shown, and whether it is reported, for tests. */
  sambotVizCamera?: { number: number | null; reported: boolean };
  /** The type of view that rviz_mouse.js follows, for tests. */
  sambotVizMouse?: { kind: string };
}

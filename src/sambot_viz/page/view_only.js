// @ts-check
/* A page without panels, such as that of a snapshot: only the view. */

import "./view/rviz_look.js";
import "./view/rviz_mouse.js";
import "./wire/cell.js";
import { connect } from "./wire/channel.js";

// A page of a picture is asked for its camera by viser, and its server may know no sessions.
if (new URLSearchParams(location.search).get("channel") !== "none") connect();

// @ts-check
/* A page without panels, such as that of a snapshot: only the view. */

import "./view/rviz_look.js";
import "./view/rviz_mouse.js";
import "./wire/cell.js";
import { connect } from "./wire/channel.js";

connect();

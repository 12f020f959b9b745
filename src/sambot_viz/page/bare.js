// @ts-check
/* A page without panels, such as that of a snapshot: only the view. */

import "./rviz_look.js";
import "./rviz_mouse.js";

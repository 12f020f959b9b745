// @ts-check
/* The page: the view as RViz draws it, and the window round it. */

// Holds a press back for a new tool: before the scripts that follow the mouse in the view.
import "./view/new_tool.js";
import "./view/drag_tool.js";
import "./view/rviz_look.js";
import "./view/rviz_mouse.js";
import "./wire/cell.js";
import "./start.js";

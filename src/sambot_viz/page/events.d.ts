// What handlers of our elements get: events whose targets are elements.

type At<E extends Event, T extends Element> = E & { readonly target: T; readonly currentTarget: T };

/** A mouse, a pen or a finger. */
type Press = At<PointerEvent, HTMLElement>;
/** A key, on an element that may be a field. */
type Key = At<KeyboardEvent, HTMLElement>;
/** A field with another value, or with the focus. */
type Change = At<Event, HTMLInputElement>;
/** What `useRef` gives, for an element that is there as soon as the component is drawn. */
type Ref<T extends Element = HTMLElement> = { current: T };

// What we look for by a selector are our elements.
interface ParentNode {
  querySelector<E extends Element = HTMLElement>(selectors: string): E | null;
  querySelectorAll<E extends Element = HTMLElement>(selectors: string): NodeListOf<E>;
}
interface Element {
  closest<E extends Element = HTMLElement>(selectors: string): E | null;
}

// The types of what our scripts use of preact.js.

export type Node = object | string | number | boolean | null | undefined;
type Effect = () => void | (() => void);

export function html(strings: TemplateStringsArray, ...values: any[]): Node;
export function render(node: Node, into: Element): void;
export function useState<T>(first: T | (() => T)): [T, (next: T | ((now: T) => T)) => void];
export function useReducer<S, A>(reduce: (now: S, action: A) => S, first: S): [S, (action: A) => void];
export function useEffect(effect: Effect, of?: readonly any[]): void;
export function useLayoutEffect(effect: Effect, of?: readonly any[]): void;
/** For an element: it is there as soon as the component is drawn. */
export function useRef(first: null): { current: any };
export function useRef<T>(first: T): { current: T };
export function useMemo<T>(make: () => T, of: readonly any[]): T;
export function useCallback<F extends (...args: any[]) => any>(call: F, of: readonly any[]): F;
export function useErrorBoundary(
  told?: (failure: any) => void,
): [failure: any, again: () => void];

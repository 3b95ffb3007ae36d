// The parts of preact, its hooks, htm and signals that the page uses, for `tsc --checkJs`.
export interface Signal<T> { value: T; peek(): T; subscribe(fn: (value: T) => void): () => void }
export interface ReadonlySignal<T> { readonly value: T; peek(): T }
export interface Ref<T> { current: T }
export type Node = any;
export function html(strings: TemplateStringsArray, ...values: any[]): Node;
export function render(node: Node, parent: Element): void;
export function signal<T>(value: T): Signal<T>;
export function computed<T>(fn: () => T): ReadonlySignal<T>;
export function effect(fn: () => void | (() => void)): () => void;
export function batch<T>(fn: () => T): T;
export function useSignal<T>(value: T): Signal<T>;
export function useComputed<T>(fn: () => T): ReadonlySignal<T>;
export function useSignalEffect(fn: () => void | (() => void)): void;
export function useState<T>(value: T | (() => T)): [T, (value: T | ((old: T) => T)) => void];
export function useEffect(fn: () => void | (() => void), inputs?: any[]): void;
export function useLayoutEffect(fn: () => void | (() => void), inputs?: any[]): void;
export function useRef<T>(value: T): Ref<T>;
export function useRef<T>(value?: T | null): Ref<T>;
export function useMemo<T>(fn: () => T, inputs: any[]): T;
export function useCallback<T>(fn: T, inputs: any[]): T;

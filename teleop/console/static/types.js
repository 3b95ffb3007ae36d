/**
 * The shapes of what the server sends, as JSDoc types; there is no code in it. docs/reference has them in words.
 *
 * @typedef {{measured: number|null, measured_age_ms: number|null, commanded: number|null, speed: number, unit: string,
 *   minimum: number|null, maximum: number|null, max_speed: number, continuous: boolean, driver: string, expo?: number}} AxisState
 * @typedef {{title: string, passes: {pass: number, axes: Object<string, {rms: number, peak: number}>}[]}} PassErrors
 * @typedef {{title: string, name?: string, phase: string, at: number|null, duration: number, speed: number, max_speed?: number, why?: string,
 *   key: number|null, keys: number, pass: number, passes: number|null}} MoveState
 * @typedef {{frames_done: number, frames: number, eta: number|null, missed: number, paused: boolean, title?: string,
 *   phase?: string, why?: string, clip_s?: number|null, interval?: number|null}} ShootState
 * @typedef {Object<string, number|string>} Positions
 * @typedef {{name: string, drives: string[], waits_for: string, trouble: string}} InputState
 * @typedef {{rig: string, tick: number, time: number, clock: number, age_ms: number, run: string, axes: Object<string, AxisState>,
 *   holder: string|null, holder_session: string|null, asking: any, stopped: boolean, stopped_by: string, stopped_at: number|null,
 *   recording: boolean, recording_s: number, camera: boolean, move: MoveState|null, shoot: ShootState|null,
 *   errors?: PassErrors|null, battery?: number|null,
 *   keys: Object<string, number>[], presets: Object<string, Positions>, range: number, ranges: number[], follow: string,
 *   focus_marks: Object<string, number>, manual: boolean, inputs: InputState[], links: Object<string, {age_ms: number|null, ok: boolean}>,
 *   sticks: {missed: number, age_ms: number|null, armed: boolean, waits_for: string}, messages: {time: number, text: string}[],
 *   fov?: [number, number], commission?: CommissionState|null, commissions?: string[], tracking?: TrackingState|null}} State
 * @typedef {{sources: Object<string, {name: string, age_ms?: number|null}>, follows?: number|null, why: string}} TrackingState
 * @typedef {{page: number, device: string, key: string, step: number, steps: number, title: string, stage: string, lines: string[], consent: string,
 *   question: string, typed?: string|null, progress: string, trouble: string, keys: [string, string][], displaced: string, moves: boolean, reason: string,
 *   facts: {key: string, title: string, documented: string, found: string, verdict: string, how: string}[],
 *   outline: {key: string, title: string, result: string}[], files?: string[]|null}} CommissionState
 * @typedef {{ok?: boolean, error?: string, kind?: string, holder?: string}} Answer
 */
export {};

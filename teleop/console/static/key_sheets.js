// What each key does, as the list behind "?" shows it. A test compares it with the terminal's.

/** @type {[string, [string, string][]][]} */
export const SHEETS = [
  ["Keys", [
    ["space", "STOP all axes (motors stay on)"], ["c", "clear STOP"], ["arrows", "pan, tilt by 1°; shift 10, ctrl 0.1"],
    ["h j k l", "pan, tilt by 0.1°; H J K L by 10"], ["< >", "roll by 1°"], ["[ ]", "focus by 1 %; { } by 10 %"],
    ["- + v", "speed range: slower, faster, next"], ["f l/y/s", "follow mode: lock, yaw, sport"], ["0-9", "recall a preset"],
    ["s 0-9", "store a preset"], ["x 0-9", "delete a preset"], ["z", "recenter"], ["r", "record on or off"], [".", "shutter"],
    ["e", "manual control on or off"], ["t word", "mark a target"], ["a 0-9", "follow a tracking source; 0 ends it"], ["d word", "drone: engage, arm"], ["b", "release the drone"],
    ["g", "play"], ["Tab, Enter", "go to a control, press it"], ["?", "these keys"],
  ]],
  ["While a move plays", [
    ["p", "pause, continue"], ["g", "continue"], ["- +", "speed"], ["< > arrows", "previous, next key, while it is paused"], ["q", "end the move"],
  ]],
  ["In a shoot", [["p", "pause between frames, continue"], [". ,", "next, previous frame, by hand"], ["q", "end the shoot"]]],
];

/** @param {any} keys */
export const openKeys = (keys) => keys;

/* globals.d.ts: what vite.config.ts defines.
 *
 * SPDX-License-Identifier: MIT */

/** A hash of facet.wasm. */
declare const FACET_STAMP: string;

import { expect, test } from 'vitest'
import { drawsByProcessor } from './drawing'

test.each([
  'ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (Subzero) (0x0000C0DE)), SwiftShader driver)',
  'llvmpipe (LLVM 15.0.7, 256 bits)',
  'ANGLE (Microsoft, Microsoft Basic Render Driver Direct3D11 vs_5_0 ps_5_0)',
  'Apple Software Renderer',
])('%s is the processor', (driver) => expect(drawsByProcessor(driver)).toBe(true))

test.each([
  'ANGLE (Intel, Intel(R) UHD Graphics 620 (0x00005917) Direct3D11 vs_5_0 ps_5_0, D3D11)',
  'ANGLE (NVIDIA, NVIDIA GeForce RTX 3060 Direct3D11 vs_5_0 ps_5_0)',
  'Mesa Intel(R) UHD Graphics 620 (KBL GT2)',
  'Apple GPU',
  '',
])('%s is a graphics card, or may be one', (driver) => expect(drawsByProcessor(driver)).toBe(false))

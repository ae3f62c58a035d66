import { fileURLToPath } from 'node:url'
import { defineConfig, type Plugin, type UserConfig } from 'vite'

const here = (path: string) => fileURLToPath(new URL(path, import.meta.url))
const output = process.env.TRUNDLE_STATIC ?? here('../src/trundle/views/viewer/static')

/** Every browser with WebGL 2 reads woff2: leave the older copies of fonts out of the bundle. */
const onlyWoff2: Plugin = {
  name: 'only-woff2',
  enforce: 'pre',
  transform(code, id) {
    if (!/\.css($|\?)/.test(id)) return null
    return code.replace(/,\s*url\([^)]*\.(?:woff|ttf)\)\s*format\(['"](?:woff|truetype)['"]\)/g, '')
  },
}

/** One self-contained module and its style: for the notebook widget and for saved pages. */
const viewer: UserConfig = {
  build: {
    outDir: output,
    emptyOutDir: true,
    assetsInlineLimit: Number.MAX_SAFE_INTEGER,
    cssCodeSplit: false,
    modulePreload: false,
    rollupOptions: {
      input: here('src/viewer/widget.ts'),
      preserveEntrySignatures: 'strict',
      output: { entryFileNames: 'viewer.js', assetFileNames: 'viewer[extname]', codeSplitting: false },
    },
  },
}

/** What runs in a live page's worker: a text that the page holds behind its law. */
const live: UserConfig = {
  build: {
    outDir: output,
    emptyOutDir: false,
    rollupOptions: {
      input: here('src/live/worker.ts'),
      output: { entryFileNames: 'live-worker.js', format: 'iife' },
    },
  },
}

/** The script of a static site's own pages. */
const site: UserConfig = {
  build: {
    outDir: output,
    emptyOutDir: false,
    rollupOptions: {
      input: here('src/site/site.ts'),
      output: { entryFileNames: 'site.js', format: 'iife' },
    },
  },
}

/** The lab page. Fonts stay files, since its policy forbids data: addresses for them. */
const lab: UserConfig = {
  base: './',
  build: {
    outDir: output,
    emptyOutDir: false,
    assetsInlineLimit: 0,
    cssCodeSplit: false, // their order is what src/lab/styles.ts says
    rollupOptions: { input: here('lab.html') },
  },
  server: { proxy: { '/api': 'http://127.0.0.1:8765' } },
}

export default defineConfig(({ mode }) => ({
  root: here('.'),
  plugins: [onlyWoff2],
  define: { 'process.env.NODE_ENV': '"production"' },
  ...{ viewer, live, site, lab }[mode as 'viewer' | 'live' | 'site' | 'lab'],
  test: {
    projects: [
      { extends: true, test: { name: 'viewer', include: ['src/viewer/**/*.test.ts'], environment: 'node' } },
      { extends: true, test: { name: 'live', include: ['src/live/**/*.test.ts'], environment: 'node' } },
      { extends: true, test: { name: 'lab', include: ['src/{lab,languages}/**/*.test.ts'], environment: 'happy-dom' } },
    ],
  },
}))

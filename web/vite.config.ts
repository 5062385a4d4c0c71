import { readFileSync } from 'node:fs';
import { svelte } from '@sveltejs/vite-plugin-svelte';
import { type Plugin, defineConfig } from 'vite';

// Two bundles of one script and one style each: report, which the C++ report writer puts into
// report.html, and app (mode "app"), the page of `manoscope serve`.
/** The licences of what the bundle holds besides our own; both ask for it, in the same words. */
function notice(): string {
  const texts = ['svelte/LICENSE.md', 'uplot/LICENSE'].map((file) =>
    readFileSync(new URL(`node_modules/${file}`, import.meta.url), 'utf8'),
  );
  const holders = texts.map((text) => /^.*copyright \(c\).*$/im.exec(text)![0].trim());
  const words = texts[0].slice(texts[0].search(/permission is hereby/i)).trim();
  return `/*! Holds Svelte, ${holders[0]}, and uPlot, ${holders[1]}; of both:\n${words}\n*/\n`;
}

/** Writes what would change how a page reads a script element as an escape; all stand in strings. */
const fitForPages: Plugin = {
  name: 'fit-for-pages',
  generateBundle(_, bundle) {
    for (const file of Object.values(bundle)) {
      if (file.type !== 'chunk') continue;
      file.code = notice() + file.code.replace(/<(?=!--|\/?script)/gi, '\\x3C');
    }
  },
};

export default defineConfig(({ mode }) => {
  const name = mode === 'app' ? 'app' : 'report';
  return {
    plugins: [svelte({ emitCss: true }), fitForPages],
    build: {
      target: 'es2022',
      outDir: process.env.MANOSCOPE_WEB_DIST ?? 'dist',
      emptyOutDir: name === 'report',
      minify: 'esbuild',
      sourcemap: false,
      modulePreload: false,
      cssCodeSplit: false,
      lib: {
        entry: name === 'app' ? 'src/app/main.ts' : 'src/main.ts',
        formats: ['iife'],
        name: 'manoscope',
        fileName: () => `${name}.js`,
        cssFileName: name,
      },
    },
    esbuild: { charset: 'ascii', legalComments: 'none' },
  };
});

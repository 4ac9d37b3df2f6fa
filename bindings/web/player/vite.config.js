import { defineConfig } from 'vite';

export default defineConfig({
  base: './', // the page may lie anywhere
  build: { target: 'es2022', assetsInlineLimit: 0, chunkSizeWarningLimit: 1000 },
  worker: { format: 'es' },
  optimizeDeps: { exclude: ['reeb'] },
});

// What is to be pasted into other pages needs the whole address, which only the page knows.
for (const code of document.querySelectorAll('textarea[data-page]')) {
  const address = new URL(code.dataset.page, location.href).href
  code.value = code.value.replace(`"${code.dataset.page}"`, `"${address}"`)
  code.addEventListener('focus', () => code.select())
}

// Prints the page. Without this script, users print with their browser's menu.
(function () {
  'use strict';
  const print = document.getElementById('print');
  print.hidden = false;
  print.addEventListener('click', () => window.print());
})();

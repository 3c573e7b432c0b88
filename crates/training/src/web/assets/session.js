// Buttons of a session's page that show moments of the video.
(function () {
  'use strict';
  const video = document.querySelector('video');
  const moments = document.getElementById('video-moments');
  if (!video || !moments) return;
  moments.hidden = false;
  for (const button of moments.querySelectorAll('button')) {
    button.addEventListener('click', () => {
      video.currentTime = Number(button.dataset.t);
      video.scrollIntoView({ block: 'nearest' });
      video.focus();
    });
  }
})();

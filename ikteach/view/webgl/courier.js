// What is sent to the kernel while something is dragged: the newest only, at most one message a
// frame, and no more than a few that the kernel has not yet answered.

const UNANSWERED = 2;
const PATIENCE = 1000; // [ms] after which an answer counts as lost

function courier(model) {
  let waiting = null, number = 0, answered = 0, sentAt = 0, asked = false;

  function post() {
    asked = false;
    if (!waiting) return;
    if (number - answered >= UNANSWERED && performance.now() - sentAt < PATIENCE) return soon();
    sentAt = performance.now();
    model.send({ ...waiting, number: ++number });
    waiting = null;
  }

  function soon() {
    if (!asked) requestAnimationFrame(post);
    asked = true;
  }

  function hear(content) {
    if (content.heard !== undefined) answered = Math.max(answered, content.heard);
  }

  model.on("msg:custom", hear);
  return {
    // A later message takes the place of one that waits, but not the sign that a move begins.
    send(message) {
      waiting = { ...message, fresh: message.fresh || Boolean(waiting?.fresh) };
      soon();
    },
    drop() { // and say what will not be sent
      const dropped = waiting;
      waiting = null;
      return dropped;
    },
    close() { model.off("msg:custom", hear); waiting = null; },
  };
}


/** Asks for the newest question only: while one is being answered the next waits, and what came in between is dropped. */
export class Latest<Question, Answer> {
  private waiting: Question | null = null;
  private busy = false;

  constructor(
    private readonly ask: (question: Question) => Promise<Answer>,
    private readonly take: (answer: Answer) => void,
    private readonly fail: (error: unknown) => void,
  ) {}

  put(question: Question): void {
    this.waiting = question;
    if (!this.busy) void this.run();
  }

  private async run(): Promise<void> {
    this.busy = true;
    while (this.waiting !== null) {
      const question = this.waiting;
      this.waiting = null;
      try {
        const answer = await this.ask(question);
        if (this.waiting === null) this.take(answer);
      } catch (error) {
        if (this.waiting === null) this.fail(error);
      }
    }
    this.busy = false;
  }
}

// The WebSocket connection, with automatic reconnection.
import { Said } from "./messages";

export class Connection {
  private socket?: WebSocket;
  constructor(private heard: (m: Said) => void, private picture: (jpeg: Blob) => void, private state: (open: boolean) => void) { this.open(); }
  private open(): void {
    const token = new URLSearchParams(location.search).get("token") ?? "";
    const socket = new WebSocket(`ws://${location.host}/ws?token=${encodeURIComponent(token)}`);
    this.socket = socket;
    socket.onopen = () => this.state(true);
    socket.onmessage = (e: MessageEvent<string | Blob>) => {
      if (typeof e.data === "string") this.heard(JSON.parse(e.data) as Said);
      else this.picture(e.data);
    };
    socket.onclose = () => { this.state(false); setTimeout(() => this.open(), 1000); };
  }
  send(message: object): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
}

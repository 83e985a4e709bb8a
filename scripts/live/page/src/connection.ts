// The WebSocket connection, with automatic reconnection.
import { ServerMessage } from "./messages";

export class Connection {
  private socket?: WebSocket;
  constructor(private onMessage: (m: ServerMessage) => void, private onPicture: (jpeg: Blob) => void, private onState: (open: boolean) => void) { this.open(); }
  private open(): void {
    const token = new URLSearchParams(location.search).get("token") ?? "";
    const socket = new WebSocket(`ws://${location.host}/ws?token=${encodeURIComponent(token)}`);
    this.socket = socket;
    socket.onopen = () => this.onState(true);
    socket.onmessage = (e: MessageEvent<string | Blob>) => {
      if (typeof e.data === "string") this.onMessage(JSON.parse(e.data) as ServerMessage);
      else this.onPicture(e.data);
    };
    socket.onclose = () => { this.onState(false); setTimeout(() => this.open(), 1000); };
  }
  send(message: object): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
}

"""Values over time that outlive their stage; no file here imports USD."""

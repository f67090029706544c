"""Pictures in memory: linear frames, raw mosaics, display pictures."""
